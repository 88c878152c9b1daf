#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Of the connected components of a surface, 1 where every edge has exactly two triangles.
std::vector<char> closed_shells(const Surface&);

}  // namespace selvedge
