#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Of each vertex the lowest one that lies where it does: within a millionth of the box's diagonal, and the same for
// chains of such. Positions must be finite.
std::vector<int> same_places(const Points& x);

// Parts vertices at one place of which `same` says no. More than a thousand at one place all part.
void part_places(const std::function<bool(int v, int w)>& same, std::vector<int>& places);

// Of each vertex the lowest one that lies where it does in every frame. There must be one at least.
std::vector<int> same_places(std::span<const Points> frames);

}  // namespace selvedge
