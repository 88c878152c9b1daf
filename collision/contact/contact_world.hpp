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
  const Points* rest = nullptr;  // rest positions of the cloth [m]; without them no pair counts as close at rest

  bool is_cloth(int node) const { return node < cloth->vertex_count; }
  int obstacle_of(int node) const;  // -1: cloth
};

// Keeps pointers to all arguments. rest: rest positions of the cloth, one row for each vertex.
ContactWorld make_contact_world(const Surface& cloth, std::vector<const Surface*> obstacles, bool self,
                                const Points* rest = nullptr);

// Positions of all nodes in that numbering.
Points gather_nodes(const Points& cloth, const std::vector<Points>& obstacles);

// For each obstacle, 1 if any of its nodes differs between x0 and x1. An obstacle that stands still does not give way.
std::vector<char> obstacles_in_motion(const ContactWorld&, const Points& x0, const Points& x1);

}  // namespace selvedge
