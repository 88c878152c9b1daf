#pragma once

#include "physics/scene/stepper.hpp"
#include "physics/solve/implicit_euler.hpp"

namespace selvedge {

// Adds a solve, its iterations and its coarse levels to the report of a step.
inline void count_solve(const NewtonReport& newton, StepReport& report) {
  report.iterations += newton.iterations;
  report.linear_iterations += newton.linear_iterations;
  ++report.counts.solves;
  report.counts.coarse_builds += newton.coarse_builds;
}

}  // namespace selvedge
