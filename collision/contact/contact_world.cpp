#include "collision/contact/contact_world.hpp"

#include <algorithm>

namespace selvedge {

int ContactWorld::obstacle_of(int node) const {
  if (is_cloth(node)) return -1;
  const auto above = std::upper_bound(first_node.begin(), first_node.end(), node);
  return static_cast<int>(above - first_node.begin()) - 1;
}

ContactWorld make_contact_world(const Surface& cloth, std::vector<const Surface*> obstacles, bool self,
                                const Points* rest) {
  ContactWorld world{&cloth, std::move(obstacles), {}, self, cloth.vertex_count, rest};
  for (const Surface* obstacle : world.obstacles) {
    world.first_node.push_back(world.node_count);
    world.node_count += obstacle->vertex_count;
  }
  return world;
}

Points gather_nodes(const Points& cloth, const std::vector<Points>& obstacles) {
  Eigen::Index count = cloth.rows();
  for (const Points& obstacle : obstacles) count += obstacle.rows();
  Points nodes(count, 3);
  nodes.topRows(cloth.rows()) = cloth;
  Eigen::Index first = cloth.rows();
  for (const Points& obstacle : obstacles) {
    nodes.middleRows(first, obstacle.rows()) = obstacle;
    first += obstacle.rows();
  }
  return nodes;
}

std::vector<char> obstacles_in_motion(const ContactWorld& world, const Points& x0, const Points& x1) {
  std::vector<char> moving(world.obstacles.size());
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const auto of_it = [&](const Points& x) {
      return x.middleRows(world.first_node[k], world.obstacles[k]->vertex_count);
    };
    moving[k] = of_it(x0) != of_it(x1);
  }
  return moving;
}

}  // namespace selvedge
