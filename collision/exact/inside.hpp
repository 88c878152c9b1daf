#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// How often the closed shells of a surface wind round each point: 1 inside a shell that is oriented outwards and does
// not cross itself, 2 where two parts overlap; 0 on the surface, and where a coordinate is undefined. Counts the
// triangles that a ray meets, by exact signs; the ray is moved aside by an infinitesimal amount so that shared edges
// and vertices count once. Open shells are left out. Positions of the surface must be finite.
std::vector<int> winding_numbers(const Surface& surface, const Points& x, const Points& points);

// Which points lie inside the union of the closed shells: their winding number is not 0.
std::vector<char> inside(const Surface& surface, const Points& x, const Points& points);

}  // namespace selvedge
