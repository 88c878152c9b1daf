#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Which of the `points` lie strictly inside the closed surface: exact parity of the triangles that a ray meets, with
// the ray moved aside by an infinitesimal amount so that shared edges and vertices count once. A point on the surface
// is not inside, and neither is a point with an undefined coordinate. The surface must be closed and finite.
std::vector<char> inside(const Surface& surface, const Points& x, const Points& points);

// How often the closed surface winds round each point, by the same rays: 1 inside a surface that is oriented outwards
// and does not cross itself, 2 where two of its parts overlap. On the surface 0.
std::vector<int> winding_numbers(const Surface& surface, const Points& x, const Points& points);

}  // namespace selvedge
