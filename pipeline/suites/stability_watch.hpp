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
  StabilityMeasures measures() const;  // all that was seen

 private:
  double energy(const State&, const Vec3& acceleration);

  const Setup& setup_;
  Scene scene_;  // as the stepper has it
  Elastic elastic_;
  Eigen::VectorXd masses_;  // lumped [kg]
  WorkBound bound_;
  State before_;
  StabilityMeasures found_;
  double lowest_ = 0;   // of the energy less all work so far [J]
  double end_sum_ = 0;  // of squared speeds in the last tenth of the run [m2/s2]
  int end_frames_ = 0;
};

}  // namespace selvedge
