#include "physics/recovery.hpp"

#include "collision/untangle.hpp"
#include "collision/world_sheets.hpp"

namespace selvedge {
namespace {

constexpr int most_pairs = 10;  // of triangles that cross, each triangle of the cloth

// Cloth that crosses itself through and through, a sheet that starts in one point say, has no sides to go to: its own
// stiffness opens it first.
bool is_hopeless(const ContactWorld& world, const Points& nodes) {
  if (!world.self) return false;
  IntersectionCache cache;
  const Points cloth = nodes.topRows(world.cloth->vertex_count);
  return intersecting_pairs(*world.cloth, cloth, cache).size() >
         most_pairs * std::size_t(world.cloth->triangles.rows());
}

// The vertices that cross the cloth still, where `untangle` says that they should be: to push them towards it for ever
// would keep the cloth from resting. Empty where there are none.
std::vector<char> tangled_at(const ContactWorld& world, const Points& nodes, const UntangleResult& parted) {
  if (!world.self || parted.pairs_after + parted.vertex_pairs_after == 0) return {};
  Points goal = nodes;
  goal.topRows(parted.x.rows()) = parted.x;
  return find_exemption(world, goal).self;
}

}  // namespace

Recovery recover(const ContactWorld& world, const Eigen::VectorXd& inverse_mass, double reach, Points& nodes) {
  const int n = world.cloth->vertex_count;
  if (is_hopeless(world, nodes)) {
    ContactWorld bodies = world;
    bodies.self = false;
    Recovery nothing{find_exemption(bodies, nodes), {}};
    nothing.left.self.assign(static_cast<std::size_t>(n), 1);
    return nothing;
  }
  Recovery recovery{find_exemption(world, nodes), {}};
  if (!recovery.left.cloth()) return recovery;
  const WorldSheets sheets(world, nodes);
  const UntangleResult parted = untangle(*world.cloth, sheets.positions[0], std::span(sheets.views).subspan(1));
  const Points& goal = parted.x;
  const std::vector<char> lost = tangled_at(world, nodes, parted);
  for (int v = 0; v < n; ++v) {
    if (!lost.empty() && lost[v]) continue;
    const Vec3 way = row(goal, v) - row(nodes, v);
    const double length = way.norm();
    if (!(inverse_mass[v] > 0 && length > 0)) continue;
    nodes.row(v) += std::min(1.0, reach / length) * way.transpose();
    Separation gained;
    gained.vertex[0] = v;
    gained.weight[0] = 1;
    gained.count = 1;
    gained.direction = way / length;
    gained.least = gained.direction.dot(row(nodes, v));
    recovery.gained.push_back(gained);
  }
  recovery.left = find_exemption(world, nodes);
  return recovery;
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
