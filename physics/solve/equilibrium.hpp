#pragma once

#include "physics/solve/implicit_euler.hpp"

namespace selvedge {

// What a scene without contact comes to rest under, pins held where they are.
struct StaticLoad {
  Vec3 acceleration = Vec3::Zero();  // [m/s2]
  const AddedTerm* added = nullptr;  // its value is minus the work of the load
  double size = 0;                   // the norm of all nodal loads [N]
};

// A frame may be left with the imbalance that its tolerances allow, since the next one sees it; at rest there is no
// next one. So each step is solved to the end, directly where CHOLMOD is in the build.
ImplicitEulerOptions to_the_end();

struct EquilibriumOptions {
  double tolerance = 1e-6;  // of the root mean square motion in a long step, in the extent of the start
  int max_steps = 300;
  ImplicitEulerOptions implicit_euler = to_the_end();
};

struct Equilibrium {
  Points x;
  bool converged = false;
  double moved = 0;     // in the last step, of the tolerance's kind
  double residual = 0;  // norm of all force imbalances, in StaticLoad::size
  int steps = 0, iterations = 0;
};

// Steps of implicit Euler from rest, velocities forgotten after each and every step longer than the one before: each
// is the minimiser of the energy near where it starts, so that the energy sinks in every step until nothing moves
// though steps are so long that inertia holds nothing back. Nothing is left of the way there: an equilibrium is stable
// where this ends in it from beside it.
Equilibrium settle(const Scene&, const Points& start, const StaticLoad&, const EquilibriumOptions& = {});

// Norm of the weights of a scene's free vertices [N].
double weight_norm(const Scene&, const Vec3& acceleration);

}  // namespace selvedge
