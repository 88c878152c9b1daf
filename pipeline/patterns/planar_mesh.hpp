#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A triangulated piece of the plane.
struct PlanarMesh {
  std::vector<Vec2> points;  // first those of the outline, in order
  Triangles triangles;       // counter-clockwise
};

// Twice the signed area of a polygon, positive where it runs counter-clockwise.
double twice_area(const std::vector<Vec2>& outline);

// Triangles of about that edge length [m] inside a simple counter-clockwise polygon. The outline's edges get no further
// vertices. No other edge joins two vertices of the outline, so that sewing outlines together never makes two edges
// one. A constrained Delaunay triangulation (Lawson's flips) of the outline and of a triangular lattice inside,
// relaxed. Throws Error for an outline that crosses itself or has no area.
PlanarMesh planar_mesh(const std::vector<Vec2>& outline, double edge);

}  // namespace selvedge
