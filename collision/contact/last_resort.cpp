#include <algorithm>

#include "collision/contact/resolution.hpp"

namespace selvedge {

std::vector<Impact> yield_rounds(Resolution& r, std::vector<Impact> impacts) {
  const std::vector<char> moving = obstacles_in_motion(r.world, r.x0, r.x1);
  if (std::ranges::count(moving, 1) == 0) return impacts;
  double inverse = mean_inverse_mass(r.inverse_mass) / r.options.yielding_mass;
  for (int round = 0; !impacts.empty() && !r.stopped() && !r.spent() && round < r.options.yield_rounds;
       ++round, inverse *= 2) {
    std::vector<char> stuck(r.world.node_count, 0);
    for (const Impact& impact : impacts)
      for (const int node : impact.pair.nodes)
        if (r.is_free(node)) stuck[r.zones.root(node)] = 1;
    const auto is_stuck = [&](const Impact& impact) {
      return std::ranges::any_of(impact.pair.nodes,
                                 [&](int node) { return r.is_free(node) && stuck[r.zones.root(node)]; });
    };
    std::vector<int> yielding;
    const auto collect = [&](const Impact& impact) {
      for (const int node : impact.pair.nodes)
        if (const int k = r.world.obstacle_of(node); k >= 0 && moving[k]) yielding.push_back(node);
    };
    for (const Impact& impact : impacts) collect(impact);
    for (const Impact& impact : r.impacts)
      if (is_stuck(impact)) collect(impact);
    for (const int node : yielding) r.inverse_mass[node] = std::max(r.inverse_mass[node], inverse);
    for (const Impact& impact : r.impacts) join_nodes(r.zones, impact, [&](int node) { return r.is_free(node); });
    zone_round(r, impacts);
    impacts = new_impacts(r);
  }
  return impacts;
}

bool shorten_rounds(Resolution& r, std::vector<Impact> impacts) {
  DisjointSets sets(r.world.node_count);
  impacts.insert(impacts.end(), r.impacts.begin(), r.impacts.end());
  std::vector<int> halved(r.world.node_count, 0);
  bool clean = true;
  const auto moves = [&r](int node) { return r.x0.row(node) != r.x1.row(node); };
  const auto belongs = [&](int node) { return r.is_free(node) || moves(node); };
  for (int round = 0; !impacts.empty() && !r.stopped(); ++round) {
    const bool spent = r.spent(), all = spent && round >= r.options.holding_rounds;
    std::vector<char> hit(r.world.node_count, 0);
    for (const Impact& impact : impacts) join_nodes(sets, impact, belongs);
    for (const Impact& impact : impacts)
      for (const int node : impact.pair.nodes)
        if (belongs(node)) hit[sets.root(node)] = 1;
    std::vector<int> most(r.world.node_count, 0);  // most halvings of any member: a set that grows continues from there
    for (int node = 0; node < r.world.node_count; ++node) {
      int& of_set = most[sets.root(node)];
      of_set = std::max(of_set, halved[node]);
    }
    for (int node = 0; node < r.world.node_count; ++node) {
      const int root = sets.root(node);
      if (!hit[root] && !all) continue;
      halved[node] = most[root] + 1;
      const double kept = spent || halved[node] > r.options.motion_halvings ? 0 : 0.5;
      r.x1.row(node) = r.x0.row(node) + kept * (r.x1.row(node) - r.x0.row(node)).eval();
      r.moved[node] = 1;
      if (node == root && hit[root]) ++r.report.shortened;
    }
    r.report.response += r.watch.lap();
    impacts = new_impacts(r);
    const auto found = impacts.size();
    std::erase_if(impacts, [&](const Impact& impact) { return std::ranges::none_of(impact.pair.nodes, moves); });
    clean = clean && impacts.size() == found;
  }
  for (int node = 0; node < r.world.node_count; ++node)
    if (halved[node] > 0 && r.world.is_cloth(node)) ++r.report.held;
  return clean;
}

}  // namespace selvedge
