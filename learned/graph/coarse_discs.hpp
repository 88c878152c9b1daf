#pragma once

#include "learned/graph/coarse_levels.hpp"

namespace selvedge {

// Long edges by discs: on level l a vertex that no disc holds yet, the lowest first, becomes the centre of a disc of
// 2.5 x 2.4^l mean edges, measured along the mesh at rest. Each vertex belongs to the nearest centre, and centres are
// joined where their cells touch. A level has about 1/20 of the edges of the level before, where the construction of
// HOOD keeps almost all of the mesh's (reference for the sizes: docs/training.md). Rest: one position a vertex.
CoarseLevels make_coarse_discs(const Surface&, const Points& rest, int count);

}  // namespace selvedge
