#include <limits>
#include <queue>

#include "collision/geometry/adjacency.hpp"
#include "learned/graph/coarse_levels.hpp"

namespace selvedge {
namespace {

constexpr double first_radius = 2.5;  // of the first level [mean edges]
constexpr double growth = 2.4;        // factor of the radius from level to level

struct DiscCells {
  std::vector<int> centre;       // of each vertex
  std::vector<double> distance;  // distance to it along edges
};

// Dijkstra's search from the centre up to the radius. It takes the vertices that are nearer to this centre than to
// their present one.
void grow_disc(const Adjacency& graph, const Points& rest, double radius, int centre, DiscCells& cells) {
  using Reached = std::pair<double, int>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto offer = [&](int v, double distance) {
    if (distance > radius || distance >= cells.distance[static_cast<std::size_t>(v)]) return;
    cells.distance[static_cast<std::size_t>(v)] = distance;
    cells.centre[static_cast<std::size_t>(v)] = centre;
    next.emplace(distance, v);
  };
  offer(centre, 0);
  while (!next.empty()) {
    const auto [distance, v] = next.top();
    next.pop();
    if (distance > cells.distance[static_cast<std::size_t>(v)]) continue;
    for (const int u : graph.of(v)) offer(u, distance + (rest.row(u) - rest.row(v)).norm());
  }
}

DiscCells disc_cells(const Adjacency& graph, const Points& rest, double radius) {
  const auto count = static_cast<std::size_t>(graph.vertex_count());
  DiscCells cells{std::vector<int>(count, -1), std::vector<double>(count, std::numeric_limits<double>::infinity())};
  for (int v = 0; v < graph.vertex_count(); ++v)
    if (cells.centre[static_cast<std::size_t>(v)] < 0) grow_disc(graph, rest, radius, v, cells);
  return cells;
}

}  // namespace

CoarseLevels make_coarse_discs(const Surface& surface, const Points& rest, int count) {
  CoarseLevels result;
  result.vertex_level.assign(static_cast<std::size_t>(surface.vertex_count), 0);
  const Adjacency graph = adjacency_of(surface.vertex_count, surface.edges);
  double radius = first_radius * mean_edge(surface, rest);
  for (int level = 0; level < count; ++level, radius *= growth) {
    const std::vector<int> centre = disc_cells(graph, rest, radius).centre;
    std::vector<std::pair<int, int>> pairs;
    for (const auto& edge : surface.edges.rowwise())
      if (const int a = centre[edge[0]], b = centre[edge[1]]; a != b)
        pairs.emplace_back(std::min(a, b), std::max(a, b));
    const Edges& edges = result.levels.emplace_back(unique_edges(std::move(pairs)));
    for (Eigen::Index i = 0; i < edges.size(); ++i) result.vertex_level[edges.data()[i]] = level + 1;
  }
  return result;
}

}  // namespace selvedge
