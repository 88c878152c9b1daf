#include "physics/recovery.hpp"

#include <algorithm>

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

// Tangled cloth that hangs together with a crossing of a part of a body that is switched off; empty where there is
// none.
std::vector<char> waiting(const ContactWorld& world, const Points& nodes, const std::vector<char>& tangled,
                          const std::vector<char>& off) {
  if (off.empty() || tangled.empty()) return {};
  const WorldSheets sheets(world, nodes);
  std::vector<char> waits(tangled.size(), 0);
  std::vector<int> front;
  const auto add = [&](int v) {
    if (!tangled[v] || waits[v]) return;
    waits[v] = 1;
    front.push_back(v);
  };
  for (const Segment& segment : find_segments(sheets.views).segments) {
    if ((segment.sheet[0] == 0) == (segment.sheet[1] == 0)) continue;
    const int side = segment.sheet[0] == 0 ? 0 : 1, obstacle = segment.sheet[1 - side] - 1;
    const auto body = world.obstacles[obstacle]->triangles.row(segment.triangle[1 - side]);
    if (std::any_of(body.begin(), body.end(), [&](int v) { return off[world.first_node[obstacle] + v] != 0; }))
      for (const int v : world.cloth->triangles.row(segment.triangle[side])) add(v);
  }
  while (!front.empty()) {
    const int v = front.back();
    front.pop_back();
    for (const int t : world.cloth->triangles_of(v))
      for (const int other : world.cloth->triangles.row(t)) add(other);
  }
  return waits;
}

bool is_marked(const std::vector<char>& marks, int v) { return !marks.empty() && marks[v] != 0; }

bool none_is_left(const Exemption& found, const std::vector<char>& waits) {
  return found.self.empty() && (found.body.empty() || found.body == waits);
}

// Where the vertices should be, for those that go there.
struct Goal {
  int vertex;
  Vec3 way;
};

std::vector<Goal> goals(const ContactWorld& world, const Eigen::VectorXd& inverse_mass, const Points& nodes,
                        const std::vector<char>& waits) {
  const WorldSheets sheets(world, nodes);
  const UntangleResult parted = untangle(*world.cloth, sheets.positions[0], std::span(sheets.views).subspan(1));
  const std::vector<char> lost = tangled_at(world, nodes, parted);
  std::vector<Goal> list;
  for (int v = 0; v < world.cloth->vertex_count; ++v) {
    const Vec3 way = row(parted.x, v) - row(nodes, v);
    if (inverse_mass[v] > 0 && way.norm() > 0 && !is_marked(lost, v) && !is_marked(waits, v)) list.push_back({v, way});
  }
  return list;
}

}  // namespace

Recovery recover(const ContactWorld& world, const Eigen::VectorXd& inverse_mass, double reach,
                 const std::vector<char>& off, Points& nodes) {
  const int n = world.cloth->vertex_count;
  if (is_hopeless(world, nodes)) {
    ContactWorld bodies = world;
    bodies.self = false;
    Recovery nothing{find_exemption(bodies, nodes), {}};
    nothing.left.self.assign(static_cast<std::size_t>(n), 1);
    return nothing;
  }
  Recovery recovery{find_exemption(world, nodes), {}};
  const bool crossed_itself = !recovery.left.self.empty();
  const std::vector<char> waits = waiting(world, nodes, recovery.left.body, off);
  if (!recovery.left.cloth() || none_is_left(recovery.left, waits)) return recovery;
  const std::vector<Goal> list = goals(world, inverse_mass, nodes, waits);
  constexpr int most_halvings = 3;
  for (int halving = 0; halving <= most_halvings; ++halving, reach /= 2) {
    Points moved = nodes;
    for (const auto& [v, way] : list) moved.row(v) += std::min(1.0, reach / way.norm()) * way.transpose();
    Exemption left = find_exemption(world, moved);
    if (!crossed_itself && !left.self.empty()) continue;
    nodes = std::move(moved);
    recovery.left = std::move(left);
    for (const auto& [v, way] : list) {
      Separation gained;
      gained.vertex[0] = v;
      gained.weight[0] = 1;
      gained.count = 1;
      gained.direction = way.normalized();
      gained.least = gained.direction.dot(row(nodes, v));
      recovery.gained.push_back(gained);
    }
    break;
  }
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
