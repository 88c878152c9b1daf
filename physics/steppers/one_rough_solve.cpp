#include "physics/steppers/one_rough_solve.hpp"

namespace selvedge {

// Measured in docs/benchmarks.md.
ConventionalOptions one_rough_solve(ConventionalOptions options) {
  options.substeps = 1;
  options.implicit_euler.max_newton = 2;
  options.implicit_euler.relative_tolerance = 0.03;
  options.implicit_euler.max_newton_step = 16;
  options.substep.max_passes = 0;
  return options;
}

}  // namespace selvedge
