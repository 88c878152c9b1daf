#pragma once

#include "pipeline/measures/minimise.hpp"
#include "pipeline/training/rolling_state.hpp"

namespace selvedge {

// The prediction with the least sum of losses [J] that L-BFGS, preconditioned by the Jacobi diagonal, finds from
// `start`. Pinned vertices stay. No network can be better in this frame.
Minimised minimised(const FrameMaking&, RollingState&, const Points& start, int most_evaluations);

}  // namespace selvedge
