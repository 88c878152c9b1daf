#pragma once

#include <optional>

#include "pipeline/scene/setup.hpp"

namespace selvedge {

struct AlgebraicError {
  double error = 0;    // RMS distance of the step's result to the minimiser over the RMS motion in the step
  double largest = 0;  // largest distance of a vertex over the same motion
  bool reference_converged = false;
};

// One step of length dt from a state without contact, as the scene's conventional stepper takes it, against the
// minimiser of the same step's incremental potential (projected Newton to a displacement of 1e-10 dt, with CHOLMOD
// where the build has it). BDF2 takes a step before it, for its history. Nothing where a step meets contact or is
// rejected, or where the scene's stepper minimises another potential.
std::optional<AlgebraicError> algebraic_error(const Setup&, const State& from, double dt);

}  // namespace selvedge
