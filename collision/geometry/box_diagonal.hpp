#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// The diagonal of the bounding box of points; 0 without rows.
inline double box_diagonal(const Points& x) {
  return x.rows() == 0 ? 0 : (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
}

}  // namespace selvedge
