#pragma once

#include <string>

#include "pipeline/run/simulate.hpp"

namespace selvedge {

// Limits of a row on a scene, so that a row that cannot be measured does not hold up the others. Members are described
// where keys are bound to them: pipeline/compare/comparison.cpp.
struct RowLimits {
  int pairs = 10;
  double seconds = 0;
};

// Intersecting pairs of cloth in the positions as a file stores them, or at the end of an audited step. The second one
// also counts where contact of cloth with itself is off, because the step's own audit does not look there.
int pairs_of_cloth(const Surface&, const Points& x);
int pairs_of_cloth(const Scene&, const StepReport&, const Points& x);

// Watches one run of a row, or all of its frames from the common states. Measuring counts as well.
class RowWatch {
 public:
  RowWatch(const RowLimits& limits, const Scene& scene) : limits_(limits), scene_(scene) {}  // keeps a reference

  bool out_of_time() const { return limits_.seconds > 0 && seconds_since(started_) > limits_.seconds; }
  // The flag for `simulate`, which ends a step too. This object must outlive it.
  StopFlag stop_flag() const;
  // Call after each frame. False ends the row.
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
