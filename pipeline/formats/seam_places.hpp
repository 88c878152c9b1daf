#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Of each vertex whether an edge there has a single triangle.
std::vector<char> on_border(const Surface&);

// Places for vertices that lie near each other, as the two sides of a seam after an export that rounds: within a
// fiftieth of the mean edge. Vertices with an edge shorter than ten times that keep their own, `same`. Of each vertex
// the lowest one at its place.
std::vector<int> near_places(const Points& x, const Surface&, const std::vector<int>& same);

// same_places(frames), and at borders also near places, if they are near in every frame. For welded_surface.hpp, which
// joins along edges alone. Needs at least one frame.
std::vector<int> seam_places(std::span<const Points> frames, const Triangles&);

}  // namespace selvedge
