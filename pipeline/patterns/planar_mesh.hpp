#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A triangulated piece of the plane.
struct PlanarMesh {
  std::vector<Vec2> points;  // first the outline's, in its order
  Triangles triangles;       // counter-clockwise
};

// Triangles of about that edge length [m] within a simple polygon that runs counter-clockwise. The outline's edges stay
// as they are: they get no vertices. No other edge joins two vertices of the outline, so that outlines can be sewn
// together without two edges becoming one. A constrained Delaunay triangulation (Lawson's flips) of the outline and of
// a triangular lattice inside, relaxed. Throws Error for an outline that crosses itself or has no area.
PlanarMesh planar_mesh(const std::vector<Vec2>& outline, double edge);

}  // namespace selvedge
