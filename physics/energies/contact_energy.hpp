#pragma once

#include <array>

#include "physics/scene/scene.hpp"

namespace selvedge {

// One proximity pair inside the implicit solve, linearised: gap d(x) = sum_i weights_i normal . x_nodes_i + offset,
// over the cloth nodes alone; what belongs to obstacles is in offset and drift. Unused slots have node -1 and weight 0.
struct ContactTerm {
  std::array<int, 4> nodes{-1, -1, -1, -1};
  std::array<double, 4> weights{};
  Vec3 normal = Vec3::UnitY();
  double offset = 0;          // [m]
  double target = 0;          // gap at which the force vanishes [m]
  double softness = 0;        // width of the cubic onset [m]
  double stiffness = 0;       // [N/m]
  double stiffest = 0;        // that a load may make it [N/m]
  double sink = 0;            // how far below its target a load may press the gap [m]
  double friction = 0;        // coefficient
  double normal_force = 0;    // lagged, for the friction bound [N]
  Vec3 drift = Vec3::Zero();  // displacement of the obstacle part: sum over obstacle nodes of weight * motion [m]
};

// Value, first and second derivative with respect to the gap of
//   0 for s <= 0, k s^3 / (6 e) for 0 < s < e, k (s^2 / 2 - e s / 2 + e^2 / 6) for s >= e, where s = target - d, e =
//   softness.
// Convex and twice continuously differentiable. [J], [N], [N/m].
struct ContactForce {
  double energy = 0, first = 0, second = 0;
};
ContactForce contact_force(const ContactTerm&, double gap);
double contact_gap(const ContactTerm&, const Points& x);  // d(x) [m]

// Lagged Coulomb friction as a potential of the tangential slip u of the step, b = mu f (the IPC form, Li et al. 2020):
// b |u| for |u| >= w = slip_width [m], b w (r^2 - r^3 / 3 + 1 / 3) with r = |u| / w below. Convex, twice continuously
// differentiable. Value [J], and the factor c >= 0 [N/m] so that gradient = c u and c (I - n n^T) is a PSD Hessian.
struct FrictionForce {
  double energy = 0, factor = 0;
};
FrictionForce friction_force(const ContactTerm&, const Vec3& slip, double slip_width);
Vec3 contact_slip(const ContactTerm&, const Points& x0, const Points& x);  // tangential part of sum w (x - x0) + drift

}  // namespace selvedge
