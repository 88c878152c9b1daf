#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Long edges over a mesh. Each level joins vertices about twice as far apart as the level before.
struct CoarseLevels {
  std::vector<Edges> levels;      // each sorted, smaller index first; empty if the mesh is too small
  std::vector<int> vertex_level;  // 1 + the deepest level with an edge at the vertex; 0: none
  std::vector<int> centres;       // one per component with edges
};

// The construction of HOOD (Grigorev et al. 2023, supplement) for each connected component. A level keeps the vertices
// at an even depth from the component's centre. A component has level l if its centre's eccentricity is at least 2^(l +
// 1). `centres` names the centres of some or all components. Others get the lowest vertex of least eccentricity, or an
// approximation of it.
CoarseLevels make_coarse_levels(const Surface&, int count, std::span<const int> centres = {}, bool approximate = false);

// Long edges by discs. On level l the lowest vertex without a disc becomes the centre of one, with a radius of 2.5 x
// 2.4^l mean edges along the mesh at rest. Each vertex belongs to the nearest centre, and centres are joined where
// their cells touch. A level has about 1/20 of the edges of the level before; HOOD's construction keeps almost all
// (sizes: docs/training.md). `rest` has one position per vertex.
CoarseLevels make_coarse_discs(const Surface&, const Points& rest, int count);

}  // namespace selvedge
