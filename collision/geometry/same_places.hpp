#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Of each vertex the lowest one at its place. Vertices within a millionth of the bounding box's diagonal are at one
// place, and so are chains of such vertices. Positions must be finite.
std::vector<int> same_places(const Points& x);
// The same with `near` [m], at least 0, as the distance within which vertices are at one place.
std::vector<int> same_places(const Points& x, double near);

// Splits places by `same`. If a place has more than a thousand vertices, each of them gets a place of its own.
void part_places(const std::function<bool(int v, int w)>& same, std::vector<int>& places);

// For each vertex the lowest one that is at its place in every frame. Needs at least one frame.
std::vector<int> same_places(std::span<const Points> frames);

}  // namespace selvedge
