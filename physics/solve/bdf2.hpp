#pragma once

#include <span>
#include <vector>

#include "physics/scene/stepper.hpp"
#include "physics/solve/step_problem.hpp"

namespace selvedge {

// What contact did with a vertex in a substep. near: something was near it, as in the substep before. begun: something
// came near it, or the response moved it, so that its velocity may have jumped.
enum class VertexContact : char { none, near, begun };

// The start of the last substep, for a two-step integrator.
struct StepHistory {
  double h = 0;  // the substep's length [s]; 0: there is no history
  Points x, v;
  std::vector<VertexContact> contact;  // in it; empty: none
  bool free() const;                   // there is a history, in which nothing was near
};

// Reads the history from a state's memory, and makes blocks of memory from it; no blocks if h is 0.
StepHistory step_history(const State&);
Memory blocks_of(const StepHistory&);
// Removes the history: to be called when something other than a step moves the cloth.
void forget_history(State&);

// The start and the length [s] of a step of implicit Euler.
struct StepStart {
  double h = 0;
  Points x, v;
};

// Backward differences of second order over steps of one length h (Hairer and Wanner, Solving Ordinary Differential
// Equations II, section III.1): with x0, v0 where the last step ended and x_, v_ where it began,
//   v1 = (3/2 x1 - 2 x0 + 1/2 x_) / h,   M (3/2 v1 - 2 v0 + 1/2 v_) / h = forces(x1, v1).
// That is implicit Euler over h' = 2 h / 3 from x' = x0 + (x0 - x_) / 3 with v' = v0 + (v0 - v_) / 3, and ends with the
// velocity (x1 - x') / h', which damping and wind see too. The damping stiffness and the speed of the air past the
// cloth are taken at x', v'; in these the scheme stays first order.
StepStart bdf2_start(const StepHistory&, const Points& x0, const Points& v0);

// How a vertex moves in a substep that has no one rule for all. bdf2: as above, but damping, air and friction see
// (x1 - x0) / h. start: a step without history, with the velocity of implicit Euler and positions from the mean of both
// velocities, x1 = x0 + h (v0 + v1) / 2, so that free fall is exact.
enum class VertexRule : char { euler, start, bdf2 };
VertexStarts starts_of(std::span<const VertexRule>, const StepHistory&, const Points& x0, const Points& v0, double h);

}  // namespace selvedge
