#include "pipeline/run/arrangement.hpp"

#include <algorithm>

namespace selvedge {
namespace {

constexpr int trial_frames = 3, kept_frames = 48;

}  // namespace

void Arrangement::change() {
  beside_ = !beside_;
  frames_ = 0;
}

void Arrangement::took(double seconds) {
  const double recent = frames_ == 0 ? seconds : std::min(seconds, before_);
  before_ = seconds;
  if (++frames_ < (trial_ ? trial_frames : kept_frames)) return;
  times_[beside_] = recent;
  const double other = times_[!beside_];
  if (!trial_ || other < 0) {
    trial_ = true;
    return change();
  }
  trial_ = false;
  frames_ = 0;
  if (other < recent) change();
}

}  // namespace selvedge
