#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

inline constexpr double facing_cosine = -0.3;  // surfaces face each other if their normals' cosine is at most this

// A body in its rest pose.
struct FacingBody {
  const Points& rest;                    // where its parts are apart [m]
  const std::vector<double>& thickness;  // of the body under each vertex [m]
  double reach;                          // largest distance of vertices that meet [m]
};

// A posed body, and for each vertex the nearest one that faces it and was farther away at rest; -1: none. Of several at
// one distance, the first in the order of a grid of cubes.
struct Facing {
  Points x, normals;  // of the pose [m], unit length
  std::vector<int> partner;
};

// For the body posed to x. `before`, of a pose from which few vertices have moved, saves time and changes nothing else.
Facing facing_vertices(const FacingBody&, const Points& x, const Points& normals, const Facing* before = nullptr);

}  // namespace selvedge
