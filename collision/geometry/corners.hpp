#pragma once

#include <array>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// The corners of a surface's triangle in its order. x: one row a vertex.
inline std::array<Vec3, 3> corners_of(const Surface& surface, const Points& x, int triangle) {
  const int* v = surface.triangles.data() + 3 * triangle;
  return {row(x, v[0]), row(x, v[1]), row(x, v[2])};
}

}  // namespace selvedge
