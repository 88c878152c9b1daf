#include "physics/recovery/recovery.hpp"

#include <algorithm>
#include <utility>

#include "collision/contact/contact_pairs.hpp"
#include "collision/contour/find_contours.hpp"
#include "collision/untangle/caught.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "collision/untangle/let_through.hpp"
#include "collision/untangle/untangle.hpp"
#include "collision/untangle/world_sheets.hpp"
#include "physics/recovery/balanced_motion.hpp"
#include "physics/recovery/lifted_off.hpp"

namespace selvedge {
namespace {

// The vertices that are tangled with the cloth even where `untangle` wants them: pushing them there for ever would keep
// the cloth from resting. Empty if there are none.
std::vector<char> tangled_at(const ContactWorld& world, const Points& nodes, const UntangleResult& parted) {
  if (!world.self || parted.pairs_after + parted.vertex_pairs_after == 0) return {};
  Points goal = nodes;
  goal.topRows(parted.x.rows()) = parted.x;
  return find_exemption(world, goal).self;
}

// 1 for tangled cloth that is connected to drawn cloth, or to a crossing with a switched-off part of a body; empty if
// there is none.
std::vector<char> trapped_vertices(const ContactWorld& world, const Points& nodes, const std::vector<char>& tangled,
                                   const std::vector<char>& switched_off, const std::vector<char>& drawn) {
  if ((switched_off.empty() && drawn.empty()) || tangled.empty()) return {};
  const WorldSheets sheets(world, nodes);
  std::vector<char> trapped(tangled.size(), 0);
  std::vector<int> front;
  const auto add = [&](int v) {
    if (!tangled[v] || trapped[v]) return;
    trapped[v] = 1;
    front.push_back(v);
  };
  for (int v = 0; v < static_cast<int>(drawn.size()); ++v)
    if (drawn[v]) add(v);
  for (const Segment& segment : find_segments(sheets.views).segments) {
    if (switched_off.empty()) break;
    if ((segment.sheet[0] == 0) == (segment.sheet[1] == 0)) continue;
    const int side = segment.sheet[0] == 0 ? 0 : 1, obstacle = segment.sheet[1 - side] - 1;
    const auto body = world.obstacles[obstacle]->triangles.row(segment.triangle[1 - side]);
    if (std::any_of(body.begin(), body.end(), [&](int v) { return switched_off[world.first_node[obstacle] + v] != 0; }))
      for (const int v : world.cloth->triangles.row(segment.triangle[side])) add(v);
  }
  while (!front.empty()) {
    const int v = front.back();
    front.pop_back();
    for (const int t : world.cloth->triangles_of(v))
      for (const int other : world.cloth->triangles.row(t)) add(other);
  }
  return trapped;
}

bool none_is_left(const Exemption& found, const std::vector<char>& trapped) {
  return found.self.empty() && (found.body.empty() || found.body == trapped);
}

// A contact term has four vertices. An edge through a face has five: the edge's nearer end replaces it.
Separation on_four(Separation s) {
  if (s.count <= 4) return s;
  const int near = s.weight[0] > s.weight[1] ? 0 : 1;
  s.vertex = {s.vertex[near], s.vertex[2], s.vertex[3], s.vertex[4], -1};
  s.weight = {1, s.weight[2], s.weight[3], s.weight[4], 0};
  s.count = 4;
  return s;
}

// The pushes that follow from the `wanted` displacement to the untangled cloth. For each separation its sides (two of
// cloth, or cloth and an obstacle) move in the direction in which `wanted` moves them apart, by the same distance but
// at most `reach` [m]. None for separations whose vertices are all `still_tangled`.
std::vector<Separation> pushes_along(const Points& wanted, const std::vector<char>& still_tangled,
                                     const WorldSheets& sheets, double shortest, double reach) {
  const Segments found = find_segments(sheets.views);
  const std::vector<Contour> contours = find_contours(sheets.views, found);
  std::vector<Separation> pushes;
  for (const Separation& s :
       part_contours(sheets.views, found, contours, enclosed_regions(sheets.views, found, contours), {})) {
    Separation push = on_four(s);
    Vec3 apart = Vec3::Zero();
    bool can_part = false;
    for (int i = 0; i < push.count; ++i) {
      apart += push.weight[i] * row(wanted, push.vertex[i]);
      can_part = can_part || still_tangled.empty() || !still_tangled[push.vertex[i]];
    }
    const double length = apart.norm();
    if (!can_part || length <= shortest) continue;
    push.direction = apart / length;
    push.least = std::min(length, reach);
    pushes.push_back(push);
  }
  return pushes;
}

// The pushes of vertices that are lifted off an obstacle, by at most `reach` [m].
void add_lifts(const Points& lifts, double reach, std::vector<Separation>& pushes) {
  for (int v = 0; v < lifts.rows(); ++v) {
    const double length = row(lifts, v).norm();
    if (length == 0) continue;
    Separation& push = pushes.emplace_back();
    push.vertex[0] = v;
    push.weight[0] = 1;
    push.direction = row(lifts, v) / length;
    push.least = std::min(length, reach);
    push.count = 1;
  }
}

// The number of pairs of the cloth's triangles that cross each other.
std::size_t pairs_within_cloth(const ContactWorld& world, const Points& nodes) {
  IntersectionCache cache;
  const Points cloth = nodes.topRows(world.cloth->vertex_count);
  return intersecting_pairs(*world.cloth, cloth, cache).size();
}

// The passes of untangling in a step in which vertices can move by `reach` [m]. Cloth in a body goes straight out;
// where cloth is tangled with itself the first passes may go the wrong way, so that it needs more.
int iterations_for(const ContactWorld& world, const Points& nodes, double reach, const Exemption& before,
                   const UntangleOptions& options, const RecoveryOptions& limits) {
  if (!before.self.empty())
    return std::min(options.iterations,
                    limits.max_pair_passes / std::max(1, static_cast<int>(pairs_within_cloth(world, nodes))));
  const double step = options.step * mean_edge(*world.cloth, nodes.topRows(world.cloth->vertex_count));
  const double useful = std::max<double>(limits.min_passes, limits.useful_motions * reach / step);
  return useful < options.iterations ? static_cast<int>(useful) : options.iterations;
}

// 1 for cloth vertices of pairs with an obstacle that meet in the motion x0 -> x1 and were clean before.
std::vector<char> meeting_obstacles(const ContactWorld& world, const Exemption& before, const Points& x0,
                                    const Points& x1) {
  ContactWorld bodies = world;
  bodies.self = false;
  PairSearch search(bodies);
  search.leave_out(&before);
  std::vector<NodePair> pairs;
  search.find(x0, x1, 0, pairs);
  std::vector<char> meeting(world.cloth->vertex_count, 0);
  for (const NodePair& pair : pairs) {
    if (!time_of_contact(pair.kind, corners(pair, x0), corners(pair, x1), 0)) continue;
    for (const int node : pair.nodes)
      if (world.is_cloth(node)) meeting[node] = 1;
  }
  return meeting;
}

// Moves vertices that would newly go through an obstacle, in the motion or at its end, back to `from`. Returns what is
// tangled then.
Exemption stop_at_obstacles(const ContactWorld& world, const Exemption& before, const Points& from, Points& nodes) {
  for (;;) {
    const std::vector<char> meeting = meeting_obstacles(world, before, from, nodes);
    Exemption left = find_exemption(world, nodes);
    bool stopped = false;
    for (Eigen::Index v = 0; v < std::ssize(meeting); ++v) {
      const bool tangled = !left.body.empty() && left.body[v] && (before.body.empty() || !before.body[v]);
      if ((!tangled && !meeting[v]) || nodes.row(v) == from.row(v)) continue;
      nodes.row(v) = from.row(v);
      stopped = true;
    }
    if (!stopped) return left;
  }
}

}  // namespace

std::optional<Exemption> too_tangled(const ContactWorld& world, const Points& nodes, const RecoveryOptions& options) {
  if (!world.self) return {};
  if (pairs_within_cloth(world, nodes) <= options.max_pairs_per_triangle * std::size_t(world.cloth->triangles.rows()))
    return {};
  ContactWorld bodies = world;
  bodies.self = false;
  Exemption exemption = find_exemption(bodies, nodes);
  exemption.self.assign(static_cast<std::size_t>(world.cloth->vertex_count), 1);
  return exemption;
}

Recovery recover(const ContactWorld& world, const Eigen::VectorXd& inverse_mass, double reach, const Exemption& before,
                 const std::vector<char>& drawn, Points& nodes, UntanglingBudget* budget,
                 const RecoveryOptions& limits) {
  const int n = world.cloth->vertex_count;
  const std::vector<char> trapped = trapped_vertices(world, nodes, before.body, before.switched_off, drawn);
  Recovery recovery{before, {}, false, trapped};
  if (!before.tangled() || none_is_left(before, trapped)) return recovery;
  UntanglingBudget ample;
  const WorldSheets sheets(world, nodes);
  const Points& from = sheets.positions[0];
  UntangleOptions options;
  for (int v = 0; v < n; ++v) options.held.push_back(inverse_mass[v] == 0);
  if (std::ranges::find(trapped, 1) != trapped.end()) {
    options.iterations = limits.trapped_passes;
    options.let_through = either(trapped, drawn);
    options.second_rule = false;
  }
  options.iterations = iterations_for(world, nodes, reach, before, options, limits);
  const Points lifted = lifted_off(world, nodes, before.body, options.held, options.gap);
  const UntangleResult parted =
      (budget ? *budget : ample).untangle(*world.cloth, lifted, std::span(sheets.views).subspan(1), options);
  const std::vector<char> still_tangled = tangled_at(world, nodes, parted);
  const Points whole = parted.x - from;
  Points wanted = whole;
  for (int v = 0; v < n; ++v)
    if (!still_tangled.empty() && still_tangled[v]) wanted.row(v).setZero();
  const std::size_t pairs = before.self.empty() ? 0 : pairs_within_cloth(world, nodes);
  for (int halving = 0; halving <= limits.max_halvings; ++halving, reach /= 2) {
    std::vector<Separation> separations =
        pushes_along(whole, still_tangled, sheets, limits.negligible_move * parted.mean_edge, reach);
    add_lifts(lifted - from, reach, separations);
    drop_let_through(options.let_through, separations);
    Points moved = nodes;
    moved.topRows(n) += balanced_motion(*world.cloth, inverse_mass, separations, wanted, reach);
    Exemption left = stop_at_obstacles(world, before, nodes, moved);
    if (before.self.empty() ? !left.self.empty() : pairs_within_cloth(world, moved) > pairs) continue;
    nodes = std::move(moved);
    recovery = {std::move(left), std::move(separations), parted.moved == 0, trapped};
    recovery.left_alone.switched_off = before.switched_off;
    break;
  }
  for (Separation& one : recovery.separations) {
    one.least = 0;
    for (int i = 0; i < one.count; ++i) one.least += one.weight[i] * one.direction.dot(row(nodes, one.vertex[i]));
  }
  return recovery;
}

SelfCrossings::SelfCrossings(const ContactWorld& world) : world_(world), known_(world.obstacles.size()) {}

bool SelfCrossings::crosses(int obstacle, const Points& nodes, bool apart, Known& known) {
  const Surface& surface = *world_.obstacles[obstacle];
  const Points x = nodes.middleRows(world_.first_node[obstacle], surface.vertex_count);
  if (x.rows() != known.x.rows() || x != known.x) {
    known.x = x;
    known.crosses = !apart && !intersecting_pairs(surface, x, known.cache).empty();
  }
  return known.crosses;
}

void SelfCrossings::switch_off(const Points& from, const Points& to, const Points& targets, Exemption& exemption,
                               const std::vector<char>& apart) {
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const int obstacle = static_cast<int>(k);
    auto& [start, end] = known_[k];
    std::swap(start, end);  // a step begins where the last one ended
    const bool before = crosses(obstacle, from, false, start),
               after = crosses(obstacle, to, !apart.empty() && apart[k], end);
    if (before || after) selvedge::switch_off(world_, obstacle, from, to, targets, exemption);
  }
}

}  // namespace selvedge
