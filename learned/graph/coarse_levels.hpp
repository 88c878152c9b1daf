#pragma once

#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Long edges over a mesh, level by level: each joins vertices about twice as far apart as the one before.
struct CoarseLevels {
  std::vector<Edges> levels;      // each sorted, smaller index first; empty where the mesh is too small
  std::vector<int> vertex_level;  // 1 + the deepest level with an edge at the vertex, 0 without
  std::vector<int> centres;       // of the components with edges, by component
};

// The construction of HOOD (Grigorev et al. 2023, supplement), one connected component at a time: a level keeps the
// vertices at an even depth from the component's centre. A component has level l if its centre's eccentricity is at
// least 2^(l + 1). `centres` names one for some or all of the components; the others get the lowest vertex of least
// eccentricity, or its approximation.
CoarseLevels make_coarse_levels(const Surface&, int count, std::span<const int> centres = {}, bool approximate = false);

}  // namespace selvedge
