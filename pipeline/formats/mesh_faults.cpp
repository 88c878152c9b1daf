#include "pipeline/formats/mesh_faults.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "collision/geometry/counted.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge {
namespace {

constexpr double flat = 0.9999;  // cosine of the angle between triangles that are folded: within a degree

constexpr double near = 1e-3;  // of an edge: what lies as near is on it

// From the line through p along the edge to a point.
Vec3 off_edge(const Vec3& p, const Vec3& edge, const Vec3& point) {
  return point - p - edge * (edge.dot(point - p) / edge.squaredNorm());
}

// Whether two triangles of an edge lie on the same side of it.
bool folded(const Points& x, const Surface& surface, Eigen::Index e) {
  const int from = surface.edges(e, 0), to = surface.edges(e, 1);
  const Vec3 p = row(x, from), edge = row(x, to) - p;
  if (!(edge.norm() > 0)) return false;
  std::vector<Vec3> sides;
  for (const int t : surface.triangles_of(from)) {
    const auto corners = surface.triangles.row(t);
    if ((corners.array() == to).any()) sides.push_back(off_edge(p, edge, row(x, corners.sum() - from - to)));
  }
  for (std::size_t a = 0; a < sides.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (sides[a].dot(sides[b]) > flat * sides[a].norm() * sides[b].norm()) return true;
  return false;
}

std::string folds_text(const Points& x, const Surface& surface) {
  int count = 0;
  Eigen::Index first = -1;
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e) {
    if (!folded(x, surface, e)) continue;
    if (count++ == 0) first = e;
  }
  if (count == 0) return "";
  return fmt::format(
      "{} flat on each other, the first at the edge of vertices {} and {}: contact cannot part them, and the cloth "
      "round them does not move; give the corners of a face in their order round it, and layers a gap",
      counted(count, "pair of neighbouring triangles lies", "pairs of neighbouring triangles lie"),
      surface.edges(first, 0), surface.edges(first, 1));
}

// Whether a point lies on the edge from a to b, and not at its ends.
bool on_edge(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length = edge.squaredNorm(), along = edge.dot(point - a);
  return along > near * length && along < (1 - near) * length &&
         (point - a - edge * (along / length)).squaredNorm() < near * near * length;
}

std::string junctions_text(const Points& x, const Surface& surface) {
  std::vector<int> border;
  for (Eigen::Index e = 0; e < surface.edges.rows(); ++e)
    if (surface.edge_triangles[static_cast<std::size_t>(e)][1] < 0)
      border.insert(border.end(), {surface.edges(e, 0), surface.edges(e, 1)});
  std::vector<int> sorted = border;  // by x
  std::ranges::sort(sorted, {}, [&](int v) { return std::pair(x(v, 0), v); });
  sorted.erase(std::ranges::unique(sorted).begin(), sorted.end());
  std::vector<int> found;
  for (std::size_t k = 0; k < border.size(); k += 2) {
    const Vec3 a = row(x, border[k]), b = row(x, border[k + 1]);
    const double margin = near * (b - a).norm();
    auto v = std::ranges::lower_bound(sorted, std::min(a.x(), b.x()) - margin, {}, [&](int i) { return x(i, 0); });
    for (; v != sorted.end() && x(*v, 0) <= std::max(a.x(), b.x()) + margin; ++v)
      if (*v != border[k] && *v != border[k + 1] && on_edge(row(x, *v), a, b)) found.push_back(*v);
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  if (found.empty()) return "";
  return fmt::format(
      "{} on an edge of another triangle and not at its ends, the first is {}: the cloth is open there; split such "
      "edges in the program that made the mesh",
      counted(std::ssize(found), "vertex lies", "vertices lie"), found[0]);
}

}  // namespace

std::vector<std::string> mesh_faults(const Points& x, const Triangles& triangles) {
  const Surface surface = make_surface(static_cast<int>(x.rows()), triangles);
  std::vector<std::string> faults;
  for (const std::string& text : {folds_text(x, surface), junctions_text(x, surface)})
    if (!text.empty()) faults.push_back(text);
  return faults;
}

}  // namespace selvedge
