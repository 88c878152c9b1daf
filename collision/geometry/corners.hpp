#pragma once

#include <array>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// The corners of a surface's triangle in its order. x: one row a vertex.
inline std::array<Vec3, 3> corners_of(const Surface& surface, const Points& x, int triangle) {
  const int* v = surface.triangles.data() + 3 * triangle;
  return {row(x, v[0]), row(x, v[1]), row(x, v[2])};
}

inline Vec3 twice_area(const Triangles& triangles, const Points& x, int triangle) {  // as a vector
  const int* v = triangles.data() + 3 * triangle;
  const Vec3 a = row(x, v[0]);
  return (row(x, v[1]) - a).cross(row(x, v[2]) - a);
}

// Do two triangles have a common vertex? Without branches, since half of them would be mispredicted.
inline bool share_vertex(const Triangles& triangles, int s, int t) {
  const int *a = triangles.data() + 3 * s, *b = triangles.data() + 3 * t;
  bool share = false;
  for (int i = 0; i < 3; ++i) share |= (a[i] == b[0]) | (a[i] == b[1]) | (a[i] == b[2]);
  return share;
}

// The weighted sum of the corners' rows in `points`.
inline Vec3 weighted_corners(const Surface& surface, const Points& points, int triangle,
                             const std::array<double, 3>& weight) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < 3; ++k) sum += weight[k] * row(points, surface.triangles(triangle, k));
  return sum;
}

}  // namespace selvedge
