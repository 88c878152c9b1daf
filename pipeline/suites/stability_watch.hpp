#pragma once

#include "pipeline/run/simulate.hpp"
#include "pipeline/suites/stability_row.hpp"

namespace selvedge {

struct Setup;

// Follows a run and keeps the books of its energy, without the forces that its stepper ignores.
class StabilityWatch {
 public:
  StabilityWatch(const Setup&, const State& start, const StepperTraits&);
  void operator()(const FrameEvent&);
  void write(StabilityRow&) const;  // all that was seen

 private:
  double energy(const State&, const Vec3& acceleration);
  void count_iterations(const StepReport&);

  const Setup& setup_;
  Scene scene_;  // as the stepper has it
  WorkBound bound_;
  EnergyTerms terms_;
  State before_;
  Work work_;
  double lowest_ = 0, unaccounted_ = 0;  // of the energy less all work so far: its least, its largest growth [J]
  double largest_ = 0;                   // kinetic and elastic energy [J]
  double newton_ = 0, linear_ = 0;
  long nonfinite_ = 0, jumped_ = 0;
  double end_sum_ = 0;  // of squared speeds in the last tenth of the run [m2/s2]
  int end_frames_ = 0;
};

}  // namespace selvedge
