#include "physics/recovery.hpp"

#include "collision/untangle.hpp"
#include "collision/world_sheets.hpp"

namespace selvedge {

Exemption recover(const ContactWorld& world, const Eigen::VectorXd& inverse_mass, double reach, Points& nodes) {
  Exemption exemption = find_exemption(world, nodes);
  if (!exemption.cloth()) return exemption;
  const int n = world.cloth->vertex_count;
  const WorldSheets sheets(world, nodes);
  const Points goal = untangle(*world.cloth, sheets.positions[0], std::span(sheets.views).subspan(1)).x;
  for (int v = 0; v < n; ++v) {
    const Vec3 way = row(goal, v) - row(nodes, v);
    const double length = way.norm();
    if (inverse_mass[v] > 0 && length > 0) nodes.row(v) += std::min(1.0, reach / length) * way.transpose();
  }
  return find_exemption(world, nodes);
}

SelfCrossings::SelfCrossings(const ContactWorld& world) : world_(world), known_(world.obstacles.size()) {}

bool SelfCrossings::crosses(int obstacle, const Points& nodes, Known& known) {
  const Surface& surface = *world_.obstacles[obstacle];
  const Points x = nodes.middleRows(world_.first_node[obstacle], surface.vertex_count);
  if (x.rows() != known.x.rows() || x != known.x) {
    known.x = x;
    known.crosses = !intersecting_pairs(surface, x, known.cache).empty();
  }
  return known.crosses;
}

void SelfCrossings::switch_off(const Points& from, const Points& to, Exemption& exemption) {
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const int obstacle = static_cast<int>(k);
    if (crosses(obstacle, from, known_[k][0])) selvedge::switch_off(world_, obstacle, from, exemption);
    if (crosses(obstacle, to, known_[k][1])) selvedge::switch_off(world_, obstacle, to, exemption);
  }
}

}  // namespace selvedge
