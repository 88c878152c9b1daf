#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// The audit's own triangle tests, edge by edge, on exact signs (orientation.hpp). The solver's are in triangle_pair.hpp
// and share no more with these than the signs.

// Do two closed triangles share a point? Touching and coplanar overlap count as intersecting. A degenerate triangle
// counts as the segment or point that it is.
bool triangles_intersect(const Vec3& a0, const Vec3& a1, const Vec3& a2, const Vec3& b0, const Vec3& b1,
                         const Vec3& b2);

// For two triangles that share exactly the vertex s: do they share more than that point?
bool triangles_cross_at_vertex(const Vec3& s, const Vec3& a1, const Vec3& a2, const Vec3& b1, const Vec3& b2);

}  // namespace selvedge
