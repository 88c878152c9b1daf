#pragma once

#include <optional>

#include "pipeline/setup.hpp"

namespace selvedge {

struct AlgebraicError {
  double error = 0;   // RMS distance of the step's result to the minimiser over the RMS motion in the step
  double motion = 0;  // RMS motion in the step [m]
  bool reference_converged = false;
};

// One implicit Euler step of length dt from a state without contact, as the scene's stepper takes it, against the
// minimiser of the same step's incremental potential (projected Newton to a displacement of 1e-10 dt). Nothing where
// the step meets contact or is rejected.
std::optional<AlgebraicError> algebraic_error(const Setup&, const State& from, double dt);

}  // namespace selvedge
