#pragma once

#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

inline constexpr double facing_cosine = -0.3;  // cosine of two normals, at most, of surfaces that face each other

// Of a body before it is posed.
struct FacingBody {
  const Points& rest;                    // where its parts are apart [m]
  const std::vector<double>& thickness;  // under each vertex [m]
  double reach;                          // within which vertices meet [m]
};

// For each vertex of the body posed to x the nearest one of a part that faces it and that was farther at rest; -1:
// none. Where several are as near, the first in the order of a grid of cubes.
std::vector<int> facing_vertices(const FacingBody&, const Points& x, const Points& normals);

}  // namespace selvedge
