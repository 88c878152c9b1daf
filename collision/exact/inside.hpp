#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// How often the closed shells of a surface wind round each point: 1 inside one that is oriented outwards and does not
// cross itself, 2 where two parts overlap. On the surface 0, and where a coordinate is undefined. By exact signs of the
// triangles that a ray meets, with the ray moved aside by an infinitesimal amount so that shared edges and vertices
// count once. Shells that are open wind round nothing. Positions of the surface must be finite.
std::vector<int> winding_numbers(const Surface& surface, const Points& x, const Points& points);

// Which of the points lie inside of the union of what the closed shells enclose: they wind round it.
std::vector<char> inside(const Surface& surface, const Points& x, const Points& points);

}  // namespace selvedge
