#pragma once

#include "learned/graph/coarse_levels.hpp"

namespace selvedge {

// Long edges by discs. On level l the lowest vertex without a disc becomes the centre of one, with a radius of 2.5 x
// 2.4^l mean edges along the mesh at rest. Each vertex belongs to the nearest centre, and centres are joined where
// their cells touch. A level has about 1/20 of the edges of the level before; HOOD's construction keeps almost all
// (sizes: docs/training.md). `rest` has one position per vertex.
CoarseLevels make_coarse_discs(const Surface&, const Points& rest, int count);

}  // namespace selvedge
