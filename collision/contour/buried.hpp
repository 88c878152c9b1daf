#pragma once

#include <vector>

#include "collision/contour/segments.hpp"

namespace selvedge {

// 1 for each triangle that faces no outside: it does not cross the surface (`found`, at x), and the union of the closed
// shells is in front of it as well as behind it. A connected piece between crossings is judged as one, by a few of its
// triangles; it faces the outside where one of these does. All 0 if all shells are open.
std::vector<char> buried_triangles(const Surface&, const Points& x, const Segments& found);

// 1 for each vertex of a triangle that crosses another or is buried; 0 everywhere if nothing crosses.
std::vector<char> buried_vertices(const Surface&, const Points& x, const Segments& found);

}  // namespace selvedge
