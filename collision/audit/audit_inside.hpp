#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// The audit's own test of sides, which shares no more with inside.hpp than exact signs: which vertices of the cloth lie
// strictly inside the closed body. `meets`, by triangle of the cloth: it shares a point with the body or has an
// undefined coordinate. The other triangles are on one side each, so that one vertex speaks for all that they join; it
// counts the faces on a segment that leaves the body. Vertices on the body, isolated or undefined ones are not inside.
// The body must be closed and finite.
std::vector<char> inside_body(const Surface& cloth, const Points& x, const std::vector<char>& meets,
                              const Surface& body, const Points& y);

}  // namespace selvedge
