#pragma once

#include <span>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

// For every vertex which of the source vertices is nearest along the edges of the rest shape, as an index into
// `sources`; -1 where none can be reached; the lower index on a tie.
std::vector<int> nearest_along_edges(const Scene&, std::span<const int> sources);

}  // namespace selvedge
