#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Which vertices of the cloth lie strictly inside the closed body, where its winding number is not 0, so also where two
// of its parts overlap: the audit's own test, which shares only exact signs with inside.hpp. `meets`, by triangle of
// the cloth: 1 if it shares a point with the body or has an undefined coordinate. Each other triangle is on one side,
// so that one vertex decides for all vertices that such triangles connect, by counting the faces on a segment that
// leaves the body, each by its direction. Vertices on the body, isolated or undefined ones are not inside. The body
// must be closed and finite, and neighbouring faces must face alike.
std::vector<char> inside_body(const Surface& cloth, const Points& x, const std::vector<char>& meets,
                              const Surface& body, const Points& y);

}  // namespace selvedge
