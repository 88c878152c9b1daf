#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Cloth and obstacles under one numbering of nodes: cloth vertices first, then each obstacle's. Constant topology.
struct ContactWorld {
  const Surface* cloth = nullptr;
  std::vector<const Surface*> obstacles;
  std::vector<int> first_node;  // of each obstacle
  bool self = true;             // cloth against itself
  int node_count = 0;
  const Points* rest = nullptr;  // of the cloth [m]; without it nothing counts as resting close

  bool is_cloth(int node) const { return node < cloth->vertex_count; }
  int obstacle_of(int node) const;  // -1: cloth
};

// Keeps all that it is given by pointer. rest: of the cloth, one row a vertex.
ContactWorld make_contact_world(const Surface& cloth, std::vector<const Surface*> obstacles, bool self,
                                const Points* rest = nullptr);

// Positions of all nodes in that numbering.
Points gather_nodes(const Points& cloth, const std::vector<Points>& obstacles);

// By obstacle, 1 where a node of it is not at x1 where it is at x0. One that stands still does not give way.
std::vector<char> obstacles_in_motion(const ContactWorld&, const Points& x0, const Points& x1);

}  // namespace selvedge
