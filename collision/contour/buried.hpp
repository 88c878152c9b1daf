#pragma once

#include <vector>

#include "collision/contour/segments.hpp"

namespace selvedge {

// The vertices of a surface that its crossing of itself, `found` at x, has on it or buried: those of triangles that
// cross, and, where the surface is closed, of each piece between these that it winds round before it as well as behind
// it. It must be oriented alike all over. 1 a vertex.
std::vector<char> buried_vertices(const Surface&, const Points& x, const Segments& found);

}  // namespace selvedge
