#include "learned/graph/coarse_levels.hpp"

#include <algorithm>

#include "collision/geometry/adjacency.hpp"
#include "learned/graph/graph_centre.hpp"

namespace selvedge {
namespace {

using VertexPairs = std::vector<std::pair<int, int>>;

std::vector<int> component_centres(const Surface& surface, const Adjacency& graph, std::span<const int> given,
                                   bool approximate) {
  std::vector<int> centres(static_cast<std::size_t>(surface.component_count), -1);
  for (const int v : given) centres[surface.component[v]] = v;
  for (int v = 0; v < surface.vertex_count; ++v) {
    int& centre = centres[surface.component[v]];
    if (centre < 0 && !graph.of(v).empty())
      centre = approximate ? approximate_graph_centre(graph, v) : graph_centre(graph, v);
  }
  std::erase(centres, -1);
  return centres;
}

// Adds edges past each vertex at an odd depth, from neighbours nearer the centre to neighbours farther away.
void join_across(const Adjacency& graph, const std::vector<int>& depth, VertexPairs& pairs) {
  for (int v = 0; v < graph.vertex_count(); ++v) {
    if (depth[v] % 2 != 1) continue;
    for (const int nearer : graph.of(v))
      for (const int farther : graph.of(v))
        if (depth[nearer] < depth[v] && depth[farther] > depth[v]) pairs.emplace_back(nearer, farther);
  }
}

// At the far end a vertex at an odd depth has no neighbour farther away. Adds edges between its nearer neighbours,
// unless they are close already.
void join_before_ends(const Adjacency& graph, const std::vector<int>& depth, const Adjacency& joined,
                      VertexPairs& pairs) {
  for (int v = 0; v < graph.vertex_count(); ++v) {
    const std::span<const int> around = graph.of(v);
    if (depth[v] % 2 != 1 || std::ranges::any_of(around, [&](int u) { return depth[u] > depth[v]; })) continue;
    for (const int a : around)
      for (const int b : around)
        if (a < b && depth[a] < depth[v] && depth[b] < depth[v] && !within_two_edges(joined, a, b))
          pairs.emplace_back(a, b);
  }
}

// Adds edges between neighbours at the same even depth, unless they are close already.
void join_beside(const Adjacency& graph, const std::vector<int>& depth, const Adjacency& joined, VertexPairs& pairs) {
  for (int v = 0; v < graph.vertex_count(); ++v) {
    if (depth[v] < 0 || depth[v] % 2 != 0) continue;
    for (const int u : graph.of(v))
      if (v < u && depth[u] == depth[v] && !within_two_edges(joined, v, u)) pairs.emplace_back(v, u);
  }
}

Edges next_level(const Adjacency& graph, std::span<const int> centres) {
  std::vector<int> depth;
  breadth_first(graph, centres, depth);
  const int count = graph.vertex_count();
  VertexPairs pairs;
  join_across(graph, depth, pairs);
  join_before_ends(graph, depth, adjacency_of(count, unique_edges(pairs)), pairs);
  join_beside(graph, depth, adjacency_of(count, unique_edges(pairs)), pairs);
  return unique_edges(std::move(pairs));
}

}  // namespace

CoarseLevels make_coarse_levels(const Surface& surface, int count, std::span<const int> centres, bool approximate) {
  CoarseLevels result;
  result.vertex_level.assign(static_cast<std::size_t>(surface.vertex_count), 0);
  if (count == 0) return result;
  Adjacency graph = adjacency_of(surface.vertex_count, surface.edges);
  result.centres = component_centres(surface, graph, centres, approximate);
  for (int level = 0; level < count; ++level) {
    const Edges& edges = result.levels.emplace_back(next_level(graph, result.centres));
    for (Eigen::Index i = 0; i < edges.size(); ++i) result.vertex_level[edges.data()[i]] = level + 1;
    graph = adjacency_of(surface.vertex_count, edges);
  }
  return result;
}

}  // namespace selvedge
