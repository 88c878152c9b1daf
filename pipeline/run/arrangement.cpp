#include "pipeline/run/arrangement.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr int trial_frames = 3, most_kept_frames = 48;
// Of the time with one beside. Less is no reason: where other programs use the cores, threads that step together wait
// for each other at every loop, and one beside waits once a frame.
constexpr double faster = 0.9;

}  // namespace

void Arrangement::change() {
  beside_ = !beside_;
  frames_ = 0;
}

void Arrangement::took(double seconds) {
  const double recent = frames_ == 0 ? seconds : std::min(seconds, before_);
  before_ = seconds;
  if (++frames_ < (trial_ ? trial_frames : kept_frames_)) return;
  times_[beside_] = recent;
  if (!trial_ || times_[!beside_] < 0) {
    trial_ = true;
    return change();
  }
  trial_ = false;
  frames_ = 0;
  kept_frames_ = std::min(2 * kept_frames_, most_kept_frames);
  if (beside_ == (times_[0] < faster * times_[1])) change();
}

}  // namespace selvedge
