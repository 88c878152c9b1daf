#include "pipeline/run/arrangement.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr int trial_frames = 3, most_kept_frames = 48;
// All threads step only if this takes less than this part of the time with one beside. Where other programs use the
// cores, stepping threads wait for each other at every loop, but one beside waits once per frame.
constexpr double faster = 0.95;

}  // namespace

void Arrangement::begin(Phase phase, bool beside) {
  phase_ = phase;
  beside_ = beside;
  frames_ = 0;
}

void Arrangement::choose(double after) {
  const double own = (before_ + after) / 2;
  const double all_step = beside_ ? other_ : own, one_beside = beside_ ? own : other_;
  kept_frames_ = std::min(2 * kept_frames_, most_kept_frames);
  begin(Phase::kept, !(all_step < faster * one_beside));
}

void Arrangement::took(double seconds) {
  const double recent = (seconds + last_) / 2;
  last_ = seconds;
  if (++frames_ < (phase_ == Phase::kept ? kept_frames_ : trial_frames)) return;
  switch (phase_) {
    case Phase::kept:
      before_ = recent;
      return begin(Phase::other, !beside_);
    case Phase::other:
      other_ = recent;
      return begin(Phase::back, !beside_);
    case Phase::back:
      return choose(recent);
  }
}

}  // namespace selvedge
