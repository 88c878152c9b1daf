#pragma once

#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Of each vertex the lowest one that lies where it does in every shape and pose: at one place at rest
// (same_places.hpp), with the same weights and directions.
std::vector<int> same_places(const SkinnedSurface&);

}  // namespace selvedge
