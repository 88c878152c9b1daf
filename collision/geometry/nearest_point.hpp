#pragma once

#include <limits>

#include "collision/geometry/cell_grid.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// A grid of points on a surface, with a few points in each cube that has any. All points must be finite.
CellGrid grid_of(const Points& x);

// point: -1 where there is none.
struct NearestPoint {
  int point = -1;
  double squared_distance = std::numeric_limits<double>::infinity();  // [m^2]
};

// The point of x nearest to `at`, the first of them on a tie. The grid is of x; `at` is finite.
NearestPoint nearest_point(const CellGrid&, const Points& x, const Vec3& at);

}  // namespace selvedge
