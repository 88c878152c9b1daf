#include "collision/contact/resolve.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>

#include "collision/contact/pair_lanes.hpp"
#include "collision/contact/pair_motion.hpp"
#include "collision/contact/resolution.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

// The least distance of each pair. It is smaller for pairs of one cloth whose rest distance is below the thickness, in
// the same ratio; otherwise every motion would force elements apart that are smaller than the thickness.
struct Separations {
  const ContactWorld& world;
  double most, part;

  Separations(const ContactWorld& w, const ResolveOptions& options)
      : world(w), most(options.separation), part(options.separation / options.thickness) {}
  double operator()(const NodePair& pair) const { return std::min(most, part * rest_distance(world, pair)); }
};

// Pairs that are looked at together for an impact.
struct Suspects {
  const Points &x0, &x1, &displacements;
  double rounding;  // of these [m]
  const Separations& separation;
  const ContactWorld* normals_of;
  std::array<const NodePair*, PairLanes::width> pairs;
  int count = 0;

  void add(const NodePair& pair, std::vector<Impact>& found) {
    pairs[count++] = &pair;
    if (count == PairLanes::width) look(found);
  }
  void look(std::vector<Impact>& found) {
    PairLanes lanes;
    for (int i = 0; i < count; ++i) lanes.set(i, *pairs[i], x0, displacements);
    const unsigned apart = pair_kernels().apart_all_the_way(lanes, separation.most + rounding);
    for (int i = 0; i < count; ++i) {
      if (apart >> i & 1) continue;
      const NodePair& pair = *pairs[i];
      auto impact = find_impact(pair, x0, x1, separation.most, normals_of);
      if (!impact) continue;
      if (const double own = separation(pair); own < separation.most)
        impact = find_impact(pair, x0, x1, own, normals_of);
      if (impact) found.push_back(*impact);
    }
    count = 0;
  }
};

// Impacts of the pairs that have a free node and a node in `moved` (empty: every node), sorted by pair.
// Adds how many paths were tested to `swept`.
std::vector<Impact> impacts_of(const PathPairs& path, const Eigen::VectorXd& inverse_mass,
                               const std::vector<char>& moved, const std::vector<char>* only,
                               const Separations& separation, const Points& x0, const Points& x1,
                               const ContactWorld* normals_of, std::int64_t& swept) {
  constexpr int chunk = 4096;
  const PairMotion motion(path.start, x0, x1);
  const Points displacements = x1 - x0;
  const int count = static_cast<int>(path.pairs.size()), chunks = (count + chunk - 1) / chunk;
  std::vector<std::vector<Impact>> found(chunks);
  std::vector<std::int64_t> tested(chunks, 0);
  StopPoll stop;
#pragma omp parallel for schedule(dynamic)
  for (int c = 0; c < chunks; ++c) {
    Suspects suspects{x0, x1, displacements, motion.rounding(), separation, normals_of, {}};
    for (int i = c * chunk, end = stop.wanted() ? 0 : std::min((c + 1) * chunk, count); i < end; ++i) {
      const NodePair& pair = path.pairs[i];
      const auto any = [&](auto&& test) { return std::any_of(pair.nodes.begin(), pair.nodes.end(), test); };
      if (only && any([&](int n) { return (*only)[n] == 0; })) continue;
      if (!moved.empty() && !any([&](int n) { return moved[n] != 0; })) continue;
      if (!motion.may_come_within(pair, path.gap[i], separation.most) ||
          !any([&](int n) { return inverse_mass[n] > 0; }))
        continue;
      ++tested[c];
      suspects.add(pair, found[c]);
    }
    if (suspects.count > 0) suspects.look(found[c]);
  }
  stop.check();
  swept = std::accumulate(tested.begin(), tested.end(), swept);
  std::vector<Impact> all;
  for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
  std::sort(all.begin(), all.end(), [](const Impact& a, const Impact& b) { return a.pair < b.pair; });
  return all;
}

double friction_of(const Resolution& r, const NodePair& pair) {
  const bool obstacle = std::any_of(pair.nodes.begin(), pair.nodes.end(), [&](int n) { return !r.world.is_cloth(n); });
  return obstacle ? r.options.friction : r.options.self_friction;
}

int free_nodes(const Resolution& r, std::span<Impact* const> impacts) {
  std::set<int> nodes;
  for (const Impact* impact : impacts)
    for (const int node : impact->pair.nodes)
      if (r.is_free(node)) nodes.insert(node);
  return static_cast<int>(nodes.size());
}

void mark_free(Resolution& r, const Impact& impact) {
  for (const int node : impact.pair.nodes)
    if (r.is_free(node)) r.moved[node] = 1;
}

void impulse_round(Resolution& r, std::vector<Impact> impacts) {
  std::stable_sort(impacts.begin(), impacts.end(), [](const Impact& a, const Impact& b) { return a.time < b.time; });
  for (Impact& impact : impacts) {
    apply_impulse(impact, r.inverse_mass, r.x0, r.x1);
    mark_free(r, impact);
  }
  r.report.impulses += static_cast<int>(impacts.size());
  r.report.response += r.watch.lap();
}

int zone_of(Resolution& r, const Impact& impact) {
  const auto& nodes = impact.pair.nodes;
  return r.zones.root(*std::find_if(nodes.begin(), nodes.end(), [&](int n) { return r.is_free(n); }));
}

// Moves a zone as one rigid body if all of its nodes are free. False for a zone with a prescribed node.
bool rigidify(Resolution& r, std::span<Impact* const> impacts) {
  std::vector<int> nodes;
  for (const Impact* impact : impacts) nodes.insert(nodes.end(), impact->pair.nodes.begin(), impact->pair.nodes.end());
  sort_once(nodes);
  if (!std::all_of(nodes.begin(), nodes.end(), [&r](int node) { return r.is_free(node); })) return false;
  rigidify_zone(nodes, r.inverse_mass, r.x0, r.x1);
  return true;
}

// The number of sweeps of a zone with so many impacts for which the remaining budget of work suffices.
int most_sweeps(const Resolution& r, std::size_t impacts) {
  const std::int64_t left = std::max<std::int64_t>(0, r.options.budget.projected - r.report.work.projected);
  const std::int64_t sweeps = left / static_cast<std::int64_t>(4 * impacts) + 1;
  return static_cast<int>(std::min<std::int64_t>(r.options.zone_sweeps, sweeps));
}

}  // namespace

std::vector<Impact> new_impacts(Resolution& r) {
  r.watch.lap();
  // Pairs that a partial search adds have a node that moved in this round, and such nodes are marked already.
  if (update_pairs(r.search, r.options.thickness, r.x0, r.x1, r.path)) std::fill(r.moved.begin(), r.moved.end(), 1);
  r.report.broad_phase += r.watch.lap();
  auto impacts = impacts_of(r.path, r.inverse_mass, r.moved, r.options.only, {r.world, r.options}, r.x0, r.x1, &r.world,
                            r.report.work.swept);
  for (Impact& impact : impacts) impact.friction = friction_of(r, impact.pair);
  std::fill(r.moved.begin(), r.moved.end(), 0);
  r.report.ccd += r.watch.lap();
  return impacts;
}

void zone_round(Resolution& r, const std::vector<Impact>& fresh) {
  for (const Impact& impact : fresh) {
    join_nodes(r.zones, impact, [&](int node) { return r.is_free(node); });
    r.impacts.push_back(impact);
  }
  std::map<int, std::vector<Impact*>> touched;
  for (const Impact& impact : fresh) touched[zone_of(r, impact)];
  for (Impact& impact : r.impacts)
    if (const auto zone = touched.find(zone_of(r, impact)); zone != touched.end()) zone->second.push_back(&impact);
  r.violation = 0;
  for (auto& [root, impacts] : touched) {
    if (r.stopped()) return;
    r.report.largest_zone = std::max(r.report.largest_zone, free_nodes(r, impacts));
    if (r.options.rigid_zones && rigidify(r, impacts)) {
      r.report.work.projected += free_nodes(r, impacts);
    } else {
      const Projection projection =
          project_zone(impacts, r.inverse_mass, r.x0, r.x1, most_sweeps(r, impacts.size()), 0.1 * r.options.separation);
      r.violation = std::max(r.violation, projection.violation);
      r.report.work.projected += projection.moved;
    }
    for (const Impact* impact : impacts) mark_free(r, *impact);
  }
  r.report.zones += static_cast<int>(touched.size());
  r.report.response += r.watch.lap();
}

std::vector<Impact> find_impacts(PairSearch& search, const Eigen::VectorXd& inverse_mass, const ResolveOptions& options,
                                 const Points& x0, const Points& x1, PathPairs& path, ResolveReport& times) {
  Stopwatch watch;
  update_pairs(search, options.thickness, x0, x1, path);
  times.broad_phase += watch.lap();
  auto impacts =
      impacts_of(path, inverse_mass, {}, options.only, {search.world(), options}, x0, x1, nullptr, times.work.swept);
  times.ccd += watch.lap();
  return impacts;
}

ResolveReport resolve(PairSearch& search, const ContactWorld& world, const Eigen::VectorXd& inverse_mass,
                      const ResolveOptions& options, const Points& x0, Points& x1, PathPairs& path) {
  Resolution r{search,       world,
               inverse_mass, options,
               x0,           x1,
               path,         {},
               {},           std::vector<char>(world.node_count, 1),
               {},           DisjointSets(world.node_count)};
  std::vector<Impact> impacts = new_impacts(r);
  r.report.found = static_cast<int>(impacts.size());
  bool contradictory = false;  // demands in zones contradict each other; more rounds do not help
  for (int round = 0; !impacts.empty() && !contradictory && !r.stopped() && !r.spent() &&
                      round < options.impulse_rounds + options.zone_rounds;
       ++round) {
    const double before = r.violation;
    if (round < options.impulse_rounds)
      impulse_round(r, std::move(impacts));
    else
      zone_round(r, impacts);
    contradictory =
        !options.last_resort && r.violation > options.separation && r.violation > 0.9 * before && before > 0;
    impacts = new_impacts(r);
  }
  if (!impacts.empty() && options.last_resort) {
    impacts = yield_rounds(r, std::move(impacts));
    if (!impacts.empty() && shorten_rounds(r, std::move(impacts))) impacts.clear();
  }
  r.report.clean = impacts.empty() && !r.report.stopped;
  return r.report;
}

}  // namespace selvedge
