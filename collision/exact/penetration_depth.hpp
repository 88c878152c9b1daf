#pragma once

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Largest distance from a point strictly inside the closed surface to the surface [m]; 0 where none is inside, and for
// an open surface, which has no inside.
double penetration_depth(const Surface& surface, const Points& x, const Points& points);

}  // namespace selvedge
