#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Of each vertex the lowest one at its place. Vertices within a millionth of the bounding box's diagonal are at one
// place, and so are chains of such vertices. Positions must be finite.
std::vector<int> same_places(const Points& x);
// The same of vertices within `near`, which is 0 or more.
std::vector<int> same_places(const Points& x, double near);

// Splits places whose vertices `same` tells apart. Of more than a thousand at one place each gets its own.
void part_places(const std::function<bool(int v, int w)>& same, std::vector<int>& places);

// Of each vertex the lowest one at its place in every frame. Needs at least one frame.
std::vector<int> same_places(std::span<const Points> frames);

}  // namespace selvedge
