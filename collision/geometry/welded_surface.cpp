#include "collision/geometry/welded_surface.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

// The faces with three different places, without repeats, ascending.
std::vector<int> kept_faces(const Surface& surface, const std::vector<int>& places) {
  std::vector<std::pair<std::array<int, 3>, int>> faces;
  for (int t = 0; t < surface.triangles.rows(); ++t)
    if (const auto at = placed_corners(surface.triangles, t, places)) faces.emplace_back(*at, t);
  std::ranges::sort(faces);
  const auto repeated = std::ranges::unique(faces, {}, [](const auto& face) { return face.first; });
  faces.erase(repeated.begin(), repeated.end());
  std::vector<int> kept;
  for (const auto& face : faces) kept.push_back(face.second);
  std::ranges::sort(kept);
  return kept;
}

// An edge of a face between two places, the lower one first.
struct PlacedEdge {
  std::array<int, 2> places, vertices;
};

std::vector<PlacedEdge> placed_edges(const Surface& surface, const std::vector<int>& kept,
                                     const std::vector<int>& places) {
  std::vector<PlacedEdge> edges;
  for (const int t : kept)
    for (int k = 0; k < 3; ++k) {
      int a = surface.triangles(t, k), b = surface.triangles(t, (k + 1) % 3);
      if (places[b] < places[a]) std::swap(a, b);
      edges.push_back({{places[a], places[b]}, {a, b}});
    }
  std::ranges::stable_sort(edges, {}, &PlacedEdge::places);
  return edges;
}

// The surface of the kept faces, with vertices joined.
WeldedSurface joined_at(const Surface& surface, const std::vector<int>& kept, DisjointSets& sets) {
  WeldedSurface result;
  for (int v = 0; v < surface.vertex_count; ++v) result.joined.push_back(sets.root(v));
  Triangles triangles = surface.triangles(kept, Eigen::all);
  for (int& v : triangles.reshaped()) v = result.joined[v];
  result.surface = make_surface(surface.vertex_count, triangles);
  return result;
}

// Bars a place at each edge that joining gave more than two faces: of its ends the one where vertices were joined.
// True if it barred any.
bool bar_crowded(const Surface& before, const std::vector<int>& kept, const WeldedSurface& after,
                 const std::vector<int>& places, std::vector<char>& barred) {
  if (after.surface.nonmanifold_edges == 0) return false;
  const std::vector<int> had = face_counts(before), has = face_counts(after.surface);
  std::vector<char> done(has.size(), 0);
  bool found = false;
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int edge = after.surface.triangle_edges(static_cast<Eigen::Index>(i), k);
      if (done[edge] || has[edge] <= 2 || has[edge] <= had[before.triangle_edges(kept[i], k)]) continue;
      for (const int v : {before.triangles(kept[i], k), before.triangles(kept[i], (k + 1) % 3)}) {
        if (done[edge] || after.joined[v] == v) continue;
        barred[places[v]] = done[edge] = 1;
        found = true;
      }
    }
  return found;
}

}  // namespace

std::optional<std::array<int, 3>> placed_corners(const Triangles& triangles, int t, const std::vector<int>& places) {
  std::array<int, 3> at{places[triangles(t, 0)], places[triangles(t, 1)], places[triangles(t, 2)]};
  if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) return {};
  std::ranges::rotate(at, std::ranges::min_element(at));
  return at;
}

std::optional<WeldedSurface> welded_surface(const Surface& surface, const std::vector<int>& places) {
  const std::vector<int> kept = kept_faces(surface, places);
  const std::vector<PlacedEdge> edges = placed_edges(surface, kept, places);
  std::vector<char> barred(places.size(), 0);
  for (;;) {
    DisjointSets sets(surface.vertex_count);
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end].places == edges[begin].places) ++end;
      if (end - begin != 2 || barred[edges[begin].places[0]] || barred[edges[begin].places[1]]) continue;
      for (std::size_t k = 0; k < 2; ++k) sets.join(edges[begin].vertices[k], edges[begin + 1].vertices[k]);
    }
    if (sets.count() == surface.vertex_count && std::ssize(kept) == surface.triangles.rows()) return {};
    WeldedSurface result = joined_at(surface, kept, sets);
    if (!bar_crowded(surface, kept, result, places, barred)) return result;
  }
}

void hold_together(const std::vector<int>& joined, Points& x) {
  for (std::size_t v = 0; v < joined.size(); ++v)
    if (const int to = joined[v]; to != static_cast<int>(v)) x.row(static_cast<Eigen::Index>(v)) = x.row(to);
}

}  // namespace selvedge
