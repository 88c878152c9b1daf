#include "pipeline/formats/seam_places.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "collision/geometry/disjoint_sets.hpp"
#include "collision/geometry/same_places.hpp"

namespace selvedge {
double seam_width(const Points& x, const Surface& surface) { return 0.02 * mean_edge(surface, x); }

std::vector<char> on_border(const Surface& surface) {
  std::vector<char> border(static_cast<std::size_t>(surface.vertex_count), 0);
  const std::vector<int> count = face_counts(surface);
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e)
    if (count[static_cast<std::size_t>(e)] == 1) border[surface.edges(e, 0)] = border[surface.edges(e, 1)] = 1;
  return border;
}

std::vector<int> near_places(const Points& x, const Surface& surface, const std::vector<int>& same) {
  const double width = seam_width(x, surface);
  std::vector<int> places = same_places(x, width);
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e)
    if (const int v = surface.edges(e, 0), w = surface.edges(e, 1); (x.row(v) - x.row(w)).norm() < 10 * width) {
      places[v] = same[v];
      places[w] = same[w];
    }
  return places;
}

std::vector<int> seam_places(std::span<const Points> frames, const Triangles& triangles) {
  const std::vector<int> same = same_places(frames);
  Surface surface = make_surface(static_cast<int>(frames.front().rows()), triangles);
  if (std::optional<WeldedSurface> welded = welded_surface(surface, same)) surface = std::move(welded->surface);
  const std::vector<char> border = on_border(surface);
  if (std::ranges::count(border, 1) == 0) return same;
  std::vector<int> places = near_places(frames.front(), surface, same);
  for (const Points& x : frames.subspan(1)) {
    const double width = seam_width(x, surface);
    part_places([&](int v, int w) { return (x.row(v) - x.row(w)).norm() <= width; }, places);
  }
  DisjointSets sets(surface.vertex_count);
  std::map<int, int> first;  // of a place its lowest vertex at a border
  for (int v = 0; v < surface.vertex_count; ++v) {
    sets.join(v, same[v]);
    if (border[v]) sets.join(v, first.try_emplace(places[v], v).first->second);
  }
  std::vector<int> joined;
  for (int v = 0; v < surface.vertex_count; ++v) joined.push_back(sets.root(v));
  return joined;
}

WeldedSurface closed_surface(std::span<Points> frames, const Triangles& triangles) {
  Surface surface = make_surface(static_cast<int>(frames.front().rows()), triangles);
  std::optional<WeldedSurface> welded =
      welded_surface(surface, seam_places(std::span<const Points>(frames), triangles));
  if (!welded) return {std::move(surface), {}};
  for (Points& x : frames) hold_together(welded->joined, x);
  return *std::move(welded);
}

}  // namespace selvedge
