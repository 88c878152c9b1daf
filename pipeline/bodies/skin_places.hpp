#pragma once

#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Of each vertex the lowest one that is at its place in every shape and pose: at the same place at rest
// (same_places.hpp), with the same weights and directions.
std::vector<int> same_places(const SkinnedSurface&);

}  // namespace selvedge
