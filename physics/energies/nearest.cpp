#include "physics/energies/nearest.hpp"

#include <queue>
#include <tuple>

namespace selvedge {
namespace {

double rest_length(const Scene& scene, int edge) {
  const int t = scene.surface.edge_owner[edge];
  const int k = scene.surface.side_of(t, edge);
  return (scene.rest_triangle[t].col(k) - scene.rest_triangle[t].col((k + 1) % 3)).norm();
}

}  // namespace

std::vector<int> nearest_along_edges(const Scene& scene, std::span<const int> sources) {
  const Surface& surface = scene.surface;
  std::vector<std::vector<std::pair<int, double>>> neighbours(surface.vertex_count);
  for (int e = 0; e < surface.edges.rows(); ++e) {
    const double length = rest_length(scene, e);
    neighbours[surface.edges(e, 0)].emplace_back(surface.edges(e, 1), length);
    neighbours[surface.edges(e, 1)].emplace_back(surface.edges(e, 0), length);
  }
  using Entry = std::tuple<double, int, int>;  // distance, source, vertex
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t s = 0; s < sources.size(); ++s) queue.emplace(0, static_cast<int>(s), sources[s]);
  std::vector<int> nearest(surface.vertex_count, -1);
  while (!queue.empty()) {
    const auto [distance, source, vertex] = queue.top();
    queue.pop();
    if (nearest[vertex] >= 0) continue;
    nearest[vertex] = source;
    for (const auto& [next, length] : neighbours[vertex])
      if (nearest[next] < 0) queue.emplace(distance + length, source, next);
  }
  return nearest;
}

}  // namespace selvedge
