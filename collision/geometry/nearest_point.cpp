#include "collision/geometry/nearest_point.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "collision/geometry/box_diagonal.hpp"

namespace selvedge {

CellGrid grid_of(const Points& x) {
  const double diagonal = box_diagonal(x), spacing = diagonal / std::sqrt(std::max<double>(1, x.rows()));
  return {x, spacing > 0 ? spacing : 1};
}

// Looks into balls that grow: what lies outside of a ball is farther than its radius.
NearestPoint nearest_point(const CellGrid& grid, const Points& x, const Vec3& at) {
  assert(at.allFinite());
  NearestPoint nearest;
  if (x.rows() == 0) return nearest;
  for (double radius = grid.distance(at) + grid.edge();; radius *= 2) {
    grid.for_each_near(at, radius, [&](int point) {
      const double squared = (x.row(point) - at.transpose()).squaredNorm();
      if (squared < nearest.squared_distance || (squared == nearest.squared_distance && point < nearest.point))
        nearest = {point, squared};
    });
    if (nearest.squared_distance <= radius * radius * (1 - 1e-12)) return nearest;
  }
}

}  // namespace selvedge
