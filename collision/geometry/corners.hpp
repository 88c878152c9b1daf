#pragma once

#include <array>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// The corners of a surface's triangle in its order. x: one row a vertex.
inline std::array<Vec3, 3> corners_of(const Surface& surface, const Points& x, int triangle) {
  const int* v = surface.triangles.data() + 3 * triangle;
  return {row(x, v[0]), row(x, v[1]), row(x, v[2])};
}

// The weighted sum of the corners' rows in `points`.
inline Vec3 weighted_corners(const Surface& surface, const Points& points, int triangle,
                             const std::array<double, 3>& weight) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 3; ++k) sum += weight[k] * row(points, surface.triangles(triangle, k));
  return sum;
}

}  // namespace selvedge
