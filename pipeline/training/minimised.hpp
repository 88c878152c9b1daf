#pragma once

#include "pipeline/training/rolling_state.hpp"

namespace selvedge {

struct Minimised {
  Points x;
  double value = 0;  // sum of the losses there [J]
  int evaluations = 0;
};

// The prediction with the least sum of losses that L-BFGS (Nocedal and Wright 2006, algorithm 7.5), preconditioned by
// the Jacobi diagonal, finds from `start`; pinned vertices stay. What a network can at best do with this frame.
Minimised minimised(const FrameMaking&, RollingState&, const Points& start, int most_evaluations);

}  // namespace selvedge
