#include "collision/exact/penetration_depth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/exact/inside.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge {

double penetration_depth(const Surface& surface, const Points& x, const Points& points) {
  if (!is_closed(surface) || !x.allFinite()) return 0;
  const std::vector<char> is_inside = inside(surface, x, points);
  double deepest = 0;
  for (int i = 0; i < points.rows(); ++i) {
    if (!is_inside[i]) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& t : surface.triangles.rowwise())
      nearest =
          std::min(nearest, point_triangle(row(points, i), row(x, t(0)), row(x, t(1)), row(x, t(2))).squared_distance);
    deepest = std::max(deepest, nearest);
  }
  return std::sqrt(deepest);
}

}  // namespace selvedge
