#pragma once

#include "physics/scene/stepper.hpp"

namespace selvedge {

// Where the last substep began, for an integrator of two steps that may go on from it.
struct StepHistory {
  double h = 0;  // its length [s]; 0: there is none
  Points x, v;
};

// The history in a state's memory, and a history as blocks of memory, none for one without length.
StepHistory step_history(const State&);
Memory blocks_of(const StepHistory&);
// For what moves a state's cloth beside its own motion: the next step has no history.
void forget_history(State&);

// Where a step of implicit Euler starts from, and how long it is [s].
struct StepStart {
  double h = 0;
  Points x, v;
};

// Backward differences of second order over steps of one length h (Hairer and Wanner, Solving Ordinary Differential
// Equations II, section III.1): with x0, v0 where the last step ended and x_, v_ where it began,
//   v1 = (3/2 x1 - 2 x0 + 1/2 x_) / h,   M (3/2 v1 - 2 v0 + 1/2 v_) / h = forces(x1, v1).
// That is implicit Euler over h' = 2 h / 3 from x' = x0 + (x0 - x_) / 3 with v' = v0 + (v0 - v_) / 3, and ends with the
// velocity (x1 - x') / h', which damping and wind see too. What these are linearised about, the stiffness that damps
// and the speed of the wind past the cloth, is that of x', v': in it the scheme stays first order.
StepStart bdf2_start(const StepHistory&, const Points& x0, const Points& v0);

}  // namespace selvedge
