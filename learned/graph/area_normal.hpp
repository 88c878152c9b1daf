#pragma once

#include "collision/geometry/surface.hpp"

namespace selvedge {

// The sum of the normals of the triangles round a vertex, each as long as twice the triangle's area [m2].
inline Vec3 area_normal(const Surface& surface, const Points& x, int vertex) {
  Vec3 sum = Vec3::Zero();
  for (const int t : surface.triangles_of(vertex)) {
    const int* v = surface.triangles.data() + 3 * t;
    const Vec3 a = row(x, v[0]);
    sum += (row(x, v[1]) - a).cross(row(x, v[2]) - a);
  }
  return sum;
}

}  // namespace selvedge
