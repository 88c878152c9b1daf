#include "learned/graph/graph_centre.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace selvedge {
namespace {

// The lowest of the deepest vertices. `order` is that of a breadth-first search.
int farthest(const std::vector<int>& order, const std::vector<int>& depth) {
  int found = order.back();
  for (auto v = order.rbegin(); v != order.rend() && depth[*v] == depth[found]; ++v) found = std::min(found, *v);
  return found;
}

struct EccentricitySearch {
  const Adjacency& graph;
  std::vector<int> members, least, depth;  // least: a lower bound of each eccentricity
  std::vector<char> searched;
  std::pair<int, int> best{std::numeric_limits<int>::max(), -1};  // eccentricity, vertex

  // Returns the vertex that is farthest from `source`.
  int search(int source) {
    const std::vector<int> order = breadth_first(graph, std::span(&source, 1), depth);
    const int far = farthest(order, depth), eccentricity = depth[far];
    searched[source] = 1;
    best = std::min(best, {eccentricity, source});
    for (const int v : members) least[v] = std::max({least[v], depth[v], eccentricity - depth[v]});
    return far;
  }

  bool may_be_better(int v) const { return !searched[v] && std::pair(least[v], v) < best; }
};

}  // namespace

int graph_centre(const Adjacency& graph, int start) {
  const auto count = static_cast<std::size_t>(graph.vertex_count());
  EccentricitySearch all{graph, {}, std::vector<int>(count, 0), {}, std::vector<char>(count, 0)};
  all.members = breadth_first(graph, std::span(&start, 1), all.depth);
  std::vector<int> candidates = all.members;
  for (int next = start; next >= 0;) {
    const int far = all.search(next);
    if (!all.searched[far]) all.search(far);
    std::erase_if(candidates, [&](int v) { return !all.may_be_better(v); });
    next = -1;
    for (const int v : candidates)
      if (next < 0 || std::pair(all.least[v], v) < std::pair(all.least[next], next)) next = v;
  }
  return all.best.second;
}

int approximate_graph_centre(const Adjacency& graph, int start) {
  std::vector<int> depth;
  const int one = farthest(breadth_first(graph, std::span(&start, 1), depth), depth);
  int at = farthest(breadth_first(graph, std::span(&one, 1), depth), depth);
  for (const int middle = depth[at] / 2; depth[at] > middle;) {
    const std::span<const int> around = graph.of(at);
    at = *std::find_if(around.begin(), around.end(), [&](int v) { return depth[v] == depth[at] - 1; });
  }
  return at;
}

}  // namespace selvedge
