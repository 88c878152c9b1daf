#pragma once

#include <array>

#include "collision/geometry/points.hpp"

namespace selvedge {

// For the solver, not for the audit: do two closed triangles share a point? Touching and coplanar overlap count, and a
// degenerate triangle counts as the segment or point that it is. Exact for finite coordinates, on the signs of
// orientation.hpp alone: triangles that cut each other's plane are compared along the line of both planes by two signs
// (Guigue and Devillers 2003). The audit has a test of its own (audit_pair.hpp).
bool triangles_meet(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace selvedge
