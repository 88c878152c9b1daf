#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// All of these are exact for any finite doubles. A floating-point filter comes first (Shewchuk 1997, stage A), then
// integers of as many digits as it takes, so that nothing underflows or overflows.

// Sign of the volume of a tetrahedron: +1 if det[b-a, c-a, d-a] > 0 (d lies on the side of triangle abc from which it
// looks counter-clockwise), -1 on the other, 0 if coplanar.
int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// Sign of the area of a triangle in the plane (counter-clockwise: +1).
int orient2d(const Vec2& a, const Vec2& b, const Vec2& c);

// The same for a triangle in space, seen along a coordinate axis: by its coordinates axis + 1 and axis + 2, modulo 3.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis);

}  // namespace selvedge
