#pragma once

#include <memory>
#include <optional>

#include "collision/contour/contour_energy.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/substep_options.hpp"

namespace selvedge {

// Options of the stepper `icm`. Members are described where keys are bound to them: pipeline/scene/config_run.cpp.
struct IcmOptions {
  std::optional<int> substeps;  // absent: chosen in each frame from the speed
  int max_substeps = 12;
  int outer_iterations = 2;
  double contour_weight = 0.1;
  ContourGradient contour_gradient = ContourGradient::translational;
  double push_speed = 0.5;
  double reach = 0.01;
  double push_softness = 0.02;
  ImplicitEulerOptions implicit_euler;
  SubstepOptions substep;
};

// Intersection contour minimisation without learning: each substep minimises
//   Phi(x) = incremental potential + repulsion + contour_weight m / h^2 * sum of squared segment lengths
// (Grigorev et al. 2024, equation 12, m the mean vertex mass) by Newton with a line search on Phi. Penetrations during
// the step are neither detected nor undone: the audit reports those that are left, as `penetrating`. Obstacles end
// where they are wanted. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_icm_stepper(const Scene&, const IcmOptions&);

}  // namespace selvedge
