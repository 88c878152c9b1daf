#pragma once

#include <span>
#include <vector>

#include "collision/geometry/welded_surface.hpp"

namespace selvedge {

// Of each vertex whether an edge there has a single triangle.
std::vector<char> on_border(const Surface&);

// How far apart the two sides of a seam lie at most after an export that rounds: a fiftieth of the mean edge.
double seam_width(const Points& x, const Surface&);

// Places for vertices that lie within a seam's width of each other. Vertices with an edge shorter than ten times that
// keep their own, `same`. Of each vertex the lowest one at its place.
std::vector<int> near_places(const Points& x, const Surface&, const std::vector<int>& same);

// same_places(frames), and at borders also near places, if they are near in every frame. For welded_surface.hpp, which
// joins along edges alone. Needs at least one frame.
std::vector<int> seam_places(std::span<const Points> frames, const Triangles&);

// The surface of a body or an obstacle with its seams closed at seam_places; the frames' vertices are moved to those
// that stand for them. All vertices keep their numbers; `joined` is empty where nothing was joined.
WeldedSurface closed_surface(std::span<Points> frames, const Triangles&);

}  // namespace selvedge
