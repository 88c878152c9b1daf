#include "collision/contour/buried.hpp"

#include "collision/exact/inside.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

constexpr double little = 1e-3;  // how far before and behind a vertex, in mean edge lengths
constexpr int speakers = 9;      // vertices that are asked for their piece, about

// What hangs together along edges between vertices that are not marked.
DisjointSets pieces_between(const std::vector<char>& marked, const Surface& surface) {
  DisjointSets pieces(surface.vertex_count);
  for (const auto& edge : surface.edges.rowwise())
    if (!marked[edge[0]] && !marked[edge[1]]) pieces.join(edge[0], edge[1]);
  return pieces;
}

}  // namespace

std::vector<char> buried_vertices(const Surface& surface, const Points& x, const Segments& found) {
  std::vector<char> marked(static_cast<std::size_t>(surface.vertex_count), 0);
  for (const Segment& segment : found.segments)
    for (const int t : segment.triangle)
      for (const int v : surface.triangles.row(t)) marked[v] = 1;
  if (found.segments.empty() || !is_closed(surface)) return marked;
  DisjointSets pieces = pieces_between(marked, surface);
  const std::vector<int> piece = pieces.numbers();
  std::vector<int> size(static_cast<std::size_t>(pieces.count()), 0), seen(size), voices(size);
  for (const int p : piece) ++size[p];
  std::vector<int> asked;
  for (int v = 0; v < surface.vertex_count; ++v)
    if (!marked[v] && seen[piece[v]]++ % (1 + size[piece[v]] / speakers) == 0) asked.push_back(v);
  const Points at = x(asked, Eigen::all);
  const Points away = little * mean_edge(surface, x) * vertex_normals(surface, x)(asked, Eigen::all);
  const std::vector<int> before = winding_numbers(surface, x, at + away);
  const std::vector<int> behind = winding_numbers(surface, x, at - away);
  for (std::size_t i = 0; i < asked.size(); ++i) voices[piece[asked[i]]] += before[i] != 0 && behind[i] != 0 ? 1 : -1;
  for (int v = 0; v < surface.vertex_count; ++v) marked[v] = marked[v] || voices[piece[v]] > 0;
  return marked;
}

}  // namespace selvedge
