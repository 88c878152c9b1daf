#include "collision/contour/buried.hpp"

#include <array>

#include "collision/exact/inside.hpp"
#include "collision/geometry/corners.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

constexpr double little = 1e-3;       // distance of test points in front of and behind a triangle, in mean edges
constexpr int samples_per_piece = 9;  // about the number of triangles that are tested in each piece

std::vector<char> crossing_triangles(const Surface& surface, const Segments& found) {
  std::vector<char> crossing(static_cast<std::size_t>(surface.triangles.rows()), 0);
  for (const Segment& segment : found.segments)
    for (const int t : segment.triangle) crossing[t] = 1;
  return crossing;
}

// Pieces: sets of triangles that do not cross, connected along edges. Each is on one side of the rest.
DisjointSets pieces_between(const std::vector<char>& crossing, const Surface& surface) {
  DisjointSets pieces(static_cast<int>(surface.triangles.rows()));
  for (const auto& [a, b] : surface.edge_triangles)
    if (b >= 0 && !crossing[a] && !crossing[b]) pieces.join(a, b);
  return pieces;
}

}  // namespace

std::vector<char> buried_triangles(const Surface& surface, const Points& x, const Segments& found) {
  std::vector<char> buried(static_cast<std::size_t>(surface.triangles.rows()), 0);
  if (found.segments.empty() && surface.component_count < 2) return buried;
  const std::vector<char> crossing = crossing_triangles(surface, found);
  DisjointSets pieces = pieces_between(crossing, surface);
  const std::vector<int> piece = pieces.numbers();
  std::vector<int> size(static_cast<std::size_t>(pieces.count()), 0), seen(size);
  for (const int p : piece) ++size[p];
  std::vector<int> asked;
  for (int t = 0; t < static_cast<int>(buried.size()); ++t)
    if (!crossing[t] && seen[piece[t]]++ % (1 + size[piece[t]] / samples_per_piece) == 0) asked.push_back(t);
  Points before(static_cast<Eigen::Index>(asked.size()), 3), behind(before);
  const double away = little * mean_edge(surface, x);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::array<Vec3, 3> at = corners_of(surface, x, asked[i]);
    const Vec3 middle = (at[0] + at[1] + at[2]) / 3, normal = (at[1] - at[0]).cross(at[2] - at[0]).normalized();
    before.row(static_cast<Eigen::Index>(i)) = (middle + away * normal).transpose();
    behind.row(static_cast<Eigen::Index>(i)) = (middle - away * normal).transpose();
  }
  const std::vector<char> in_front = inside(surface, x, before), in_back = inside(surface, x, behind);
  std::vector<char> faces_outside(size.size(), 0);
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (!in_front[i] || !in_back[i]) faces_outside[piece[asked[i]]] = 1;
  for (std::size_t t = 0; t < buried.size(); ++t) buried[t] = !crossing[t] && !faces_outside[piece[t]];
  return buried;
}

std::vector<char> buried_vertices(const Surface& surface, const Points& x, const Segments& found) {
  std::vector<char> marked(static_cast<std::size_t>(surface.vertex_count), 0);
  if (found.segments.empty()) return marked;
  const std::vector<char> crossing = crossing_triangles(surface, found), buried = buried_triangles(surface, x, found);
  for (std::size_t t = 0; t < buried.size(); ++t)
    if (crossing[t] || buried[t])
      for (const int v : surface.triangles.row(static_cast<Eigen::Index>(t))) marked[v] = 1;
  return marked;
}

}  // namespace selvedge
