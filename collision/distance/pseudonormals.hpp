#pragma once

#include "collision/geometry/surface.hpp"

namespace selvedge {

// True if every edge has two triangles that run along it in opposite directions, and the triangles round each vertex
// are one fan. Then the angle-weighted normal at the closest point tells on which side a point is.
bool is_closed_manifold(const Surface&);

// Normals that tell sides (Baerentzen and Aanaes 2005): of a triangle its own, of an edge the sum of its two
// triangles', of a vertex the sum of its triangles' weighted by their angles there. Unit length; zero (no side known)
// where one of the triangles has no area, or where the sum vanishes.
Vec3 face_normal(const Surface&, const Points& x, int triangle);
Vec3 edge_pseudonormal(const Surface&, const Points& x, int edge);
Vec3 vertex_pseudonormal(const Surface&, const Points& x, int vertex);

}  // namespace selvedge
