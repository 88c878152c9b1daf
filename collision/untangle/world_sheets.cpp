#include "collision/untangle/world_sheets.hpp"

namespace selvedge {

WorldSheets::WorldSheets(const ContactWorld& world, const Points& nodes) {
  positions.push_back(nodes.topRows(world.cloth->vertex_count));
  for (std::size_t k = 0; k < world.obstacles.size(); ++k)
    positions.push_back(nodes.middleRows(world.first_node[k], world.obstacles[k]->vertex_count));
  views.push_back({world.cloth, &positions[0]});
  for (std::size_t k = 0; k < world.obstacles.size(); ++k) views.push_back({world.obstacles[k], &positions[k + 1]});
}

}  // namespace selvedge
