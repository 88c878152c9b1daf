#pragma once

#include <string>

#include "pipeline/run/simulate.hpp"

namespace selvedge {

// What a row may take of a scene: one that cannot be measured must not hold up the others.
struct RowLimits {
  int pairs = 10;      // intersecting pairs of cloth, a triangle, at the end of a frame; 0: any number
  double seconds = 0;  // of a run, and of all frames from the common states together; 0: any time
};

// Intersecting pairs of cloth in the positions as a file stores them; and at the end of a step that was audited, also
// where the run leaves out contact of cloth with itself: its own audit does not look at them then.
int pairs_of_cloth(const Surface&, const Points& x);
int pairs_of_cloth(const Scene&, const StepReport&, const Points& x);

// Watches one run of a row, or all of its frames from the common states. Measuring counts as well.
class RowWatch {
 public:
  RowWatch(const RowLimits& limits, const Scene& scene) : limits_(limits), scene_(scene) {}  // keeps a reference

  bool out_of_time() const { return limits_.seconds > 0 && seconds_since(started_) > limits_.seconds; }
  // For `simulate`: ends a step too. This must outlive it.
  StopFlag stop_flag() const;
  // After a frame; false: the row ends with it.
  bool goes_on(const StepReport&, const Points& x);
  // Why the run that came to frame `last` of `frames` ended there; empty: by no limit.
  std::string trouble(int last, int frames) const;

 private:
  RowLimits limits_;
  const Scene& scene_;
  int pairs_ = 0;  // too many, if not 0
  Clock::time_point started_ = Clock::now();
};

}  // namespace selvedge
