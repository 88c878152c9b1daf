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

}  // namespace selvedge
