#pragma once

#include <memory>
#include <optional>

#include "collision/contour/contour_energy.hpp"
#include "physics/scene/stepper.hpp"
#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/substep_options.hpp"

namespace selvedge {

struct IcmOptions {
  std::optional<int> substeps;  // nothing: chosen each frame from the speed
  int max_substeps = 12;
  int outer_iterations = 2;     // a substep: pairs found anew, then a minimisation
  double contour_weight = 0.1;  // of the contour energy, in mean vertex masses over h^2: without unit
  ContourGradient contour_gradient = ContourGradient::translational;
  double push_speed = 0.5;      // at which vertices on the wrong side are asked back [m/s]; 0: the contour energy alone
  double reach = 0.01;          // how far apart pairs may be that are kept from passing each other [m]
  double push_softness = 0.02;  // A push sets in over this part of the thickness.
  ImplicitEulerOptions implicit_euler;
  SubstepOptions substep;
};

// Intersection contour minimisation without learning: each substep minimises
//   Phi(x) = incremental potential + repulsion + contour_weight m / h^2 * sum of squared segment lengths
// (Grigorev et al. 2024, equation 12, m the mean vertex mass) by Newton with a line search on Phi. Penetrations during
// the step are neither detected nor undone: the audit finds and reports what is left, as `penetrating`.
// Obstacles are where they are wanted. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_icm_stepper(const Scene&, const IcmOptions&);

}  // namespace selvedge
