#include "collision/geometry/adjacency.hpp"

#include <algorithm>

#include "collision/geometry/lists.hpp"

namespace selvedge {

Adjacency adjacency_of(int vertex_count, const Edges& edges) {
  const std::span<const int> ends(edges.data(), static_cast<std::size_t>(edges.size()));
  IndexLists by = indices_by_value(ends, vertex_count);
  for (int& i : by.item) i = ends[i ^ 1];  // the other end of the edge
  Adjacency result{std::move(by.begin), std::move(by.item)};
  for (int v = 0; v < vertex_count; ++v)
    std::sort(result.neighbour.begin() + result.begin[v], result.neighbour.begin() + result.begin[v + 1]);
  return result;
}

bool within_two_edges(const Adjacency& graph, int a, int b) {
  if (a == b) return true;
  const std::span<const int> of_a = graph.of(a), of_b = graph.of(b);
  if (std::binary_search(of_a.begin(), of_a.end(), b)) return true;
  for (auto i = of_a.begin(), j = of_b.begin(); i != of_a.end() && j != of_b.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

std::vector<int> breadth_first(const Adjacency& graph, std::span<const int> sources, std::vector<int>& depth) {
  depth.assign(static_cast<std::size_t>(graph.vertex_count()), -1);
  std::vector<int> order(sources.begin(), sources.end());
  order.reserve(depth.size());
  for (const int source : sources) depth[source] = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const int next : graph.of(order[i]))
      if (depth[next] < 0) {
        depth[next] = depth[order[i]] + 1;
        order.push_back(next);
      }
  return order;
}

Edges unique_edges(std::vector<std::pair<int, int>> pairs) {
  for (auto& [a, b] : pairs)
    if (b < a) std::swap(a, b);
  sort_once(pairs);
  Edges edges(static_cast<Eigen::Index>(pairs.size()), 2);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    edges.row(static_cast<Eigen::Index>(i)) << pairs[i].first, pairs[i].second;
  return edges;
}

}  // namespace selvedge
