#include "physics/solve/bdf2.hpp"

#include <cassert>

namespace selvedge {

// Written with differences, so that what rests gives its own positions, bit for bit.
StepStart bdf2_start(const StepHistory& history, const Points& x0, const Points& v0) {
  assert(history.h > 0 && history.x.rows() == x0.rows() && history.v.rows() == v0.rows());
  return {2 * history.h / 3, x0 + (x0 - history.x) / 3, v0 + (v0 - history.v) / 3};
}

}  // namespace selvedge
