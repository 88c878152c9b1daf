#pragma once

#include "collision/points.hpp"

namespace selvedge {

// Exact sign of the volume of a tetrahedron: +1 if d lies on the side of triangle abc from which it looks clockwise
// (det[b-a, c-a, d-a] > 0), -1 on the other, 0 if coplanar. Floating filter first, then exact expansions; no
// underflow or overflow for coordinates of magnitude 1e-100 .. 1e100 or zero.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// Exact sign of the area of a triangle in the plane (counter-clockwise: +1).
int orient2d(const Vec2& a, const Vec2& b, const Vec2& c);

// Do two closed triangles share a point? Exact for any doubles; touching and coplanar overlap count as intersecting.
// A degenerate triangle counts as the segment or point that it is.
bool triangles_intersect(const Vec3& a0, const Vec3& a1, const Vec3& a2, const Vec3& b0, const Vec3& b1,
                         const Vec3& b2);

// For two triangles that share exactly the vertex s: do they share more than that point? Exact in the same sense.
bool triangles_cross_at_vertex(const Vec3& s, const Vec3& a1, const Vec3& a2, const Vec3& b1, const Vec3& b2);

}  // namespace selvedge
