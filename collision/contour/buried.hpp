#pragma once

#include <vector>

#include "collision/contour/segments.hpp"

namespace selvedge {

// The triangles of a surface that do not face the outside of the whole: they do not cross it (`found`, at x), and the
// union of what its closed shells enclose is before them as well as behind. A piece between crossings is judged as one,
// and faces the outside where one of the triangles asked for it does. 1 a triangle. Nothing where all shells are open.
std::vector<char> buried_triangles(const Surface&, const Points& x, const Segments& found);

// The vertices of triangles that cross, and of buried ones; none where nothing crosses. 1 a vertex.
std::vector<char> buried_vertices(const Surface&, const Points& x, const Segments& found);

}  // namespace selvedge
