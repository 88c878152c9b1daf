#pragma once

#include "physics/solve/implicit_euler.hpp"

namespace selvedge {

// The load of an equilibrium without contact; pins are held where they are.
struct StaticLoad {
  Vec3 acceleration = Vec3::Zero();  // [m/s2]
  const AddedTerm* added = nullptr;  // its value is minus the work of the load
  double size = 0;                   // the norm of all nodal loads [N]
};

// Options that solve each step to the end, by CHOLMOD if the build has it. A frame may leave an imbalance within its
// tolerances, since the next frame corrects it; an equilibrium has no next frame.
ImplicitEulerOptions to_the_end();

struct EquilibriumOptions {
  double tolerance = 1e-6;  // of the RMS motion in a long step, relative to the extent of the start
  int max_steps = 300;
  ImplicitEulerOptions implicit_euler = to_the_end();
};

struct Equilibrium {
  Points x;
  bool converged = false;
  double moved = 0;     // in the last step, in the units of the tolerance
  double residual = 0;  // norm of all force imbalances, divided by StaticLoad::size
  int steps = 0, iterations = 0;
};

// Takes steps of implicit Euler, each from rest and longer than the one before. Each step minimises the energy near its
// start, so that the energy falls in every step. It ends when nothing moves although steps are so long that inertia has
// no effect. The result does not depend on inertia: an equilibrium is stable if starts near it end in it.
Equilibrium settle(const Scene&, const Points& start, const StaticLoad&, const EquilibriumOptions& = {});

// Norm of the weights of a scene's free vertices [N].
double weight_norm(const Scene&, const Vec3& acceleration);

}  // namespace selvedge
