#include "pipeline/measures/fit_girth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace selvedge {
namespace {

// The cut of a plane with a triangle: points on two of its sides, as weights of its corners.
struct CutTriangle {
  int triangle = 0;
  std::array<int, 2> edges{};  // of the surface
  std::array<Vec3, 2> ends{};
};

std::optional<CutTriangle> cut_of(const Surface& surface, int t, const Points& x, const CutPlane& plane) {
  std::array<double, 3> heights;
  for (int k = 0; k < 3; ++k) heights[k] = plane.normal.dot(row(x, surface.triangles(t, k))) - plane.offset;
  CutTriangle cut{t};
  int count = 0;
  for (int k = 0; k < 3 && count < 2; ++k) {
    const double a = heights[k], b = heights[(k + 1) % 3];
    if ((a < 0) == (b < 0)) continue;
    cut.edges[count] = surface.triangle_edges(t, k);
    cut.ends[count] = Vec3::Zero();
    cut.ends[count][k] = b / (b - a);
    cut.ends[count][(k + 1) % 3] = -a / (b - a);
    ++count;
  }
  return count == 2 ? std::optional(cut) : std::nullopt;
}

Vec3 in_space(const Surface& surface, int t, const Points& x, const Vec3& weights) {
  return weights[0] * row(x, surface.triangles(t, 0)) + weights[1] * row(x, surface.triangles(t, 1)) +
         weights[2] * row(x, surface.triangles(t, 2));
}

// Coordinates in a plane, from a point.
struct PlaneAxes {
  Vec3 origin, u, v;
  PlaneAxes(const CutPlane& plane, const Vec3& from)
      : origin(from), u(plane.normal.unitOrthogonal()), v(plane.normal.cross(u)) {}
  Vec2 of(const Vec3& point) const { return {u.dot(point - origin), v.dot(point - origin)}; }
};

using CutLoop = std::vector<CutTriangle>;

// The closed loops of a plane's cut with triangles, triangle after triangle; open curves are left out.
std::vector<CutLoop> closed_loops(const Surface& surface, int first, int count, const Points& x,
                                  const CutPlane& plane) {
  std::vector<CutTriangle> cuts;
  std::map<int, std::vector<int>> at_edge;
  for (int t = first; t < first + count; ++t)
    if (const auto cut = cut_of(surface, t, x, plane)) {
      for (const int edge : cut->edges) at_edge[edge].push_back(static_cast<int>(cuts.size()));
      cuts.push_back(*cut);
    }
  std::vector<CutLoop> loops;
  std::vector<char> seen(cuts.size(), 0);
  for (std::size_t begin = 0; begin < cuts.size(); ++begin) {
    CutLoop loop;
    bool closed = true;
    std::vector<int> waiting = {static_cast<int>(begin)};
    while (!waiting.empty()) {
      const int at = waiting.back();
      waiting.pop_back();
      if (seen[at]) continue;
      seen[at] = 1;
      loop.push_back(cuts[at]);
      for (const int edge : cuts[at].edges) {
        closed = closed && at_edge[edge].size() > 1;
        for (const int next : at_edge[edge]) waiting.push_back(next);
      }
    }
    if (!loop.empty() && closed) loops.push_back(loop);
  }
  return loops;
}

// True if a ray from the origin crosses an odd number of its segments.
bool goes_round_origin(const Surface& surface, const CutLoop& loop, const Points& x, const PlaneAxes& axes) {
  bool inside = false;
  for (const CutTriangle& cut : loop) {
    const Vec2 a = axes.of(in_space(surface, cut.triangle, x, cut.ends[0])),
               b = axes.of(in_space(surface, cut.triangle, x, cut.ends[1]));
    if ((a.y() < 0) == (b.y() < 0)) continue;
    if (a.x() + (b.x() - a.x()) * a.y() / (a.y() - b.y()) > 0) inside = !inside;
  }
  return inside;
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Andrew's monotone chain.
double hull_length(std::vector<Vec2> points) {
  std::ranges::sort(points,
                    [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  std::vector<Vec2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t begin = hull.size();
    for (const Vec2& point : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  double length = 0;
  for (std::size_t k = 0; k < hull.size(); ++k) length += (hull[(k + 1) % hull.size()] - hull[k]).norm();
  return length;
}

}  // namespace

std::optional<Vec3> section_middle(const Surface& surface, const std::vector<int>& which, const Points& x,
                                   const CutPlane& plane) {
  const PlaneAxes axes(plane, plane.offset * plane.normal);
  Vec2 low = Vec2::Constant(INFINITY), high = -low;
  for (const int t : which)
    if (const auto cut = cut_of(surface, t, x, plane))
      for (const Vec3& end : cut->ends) {
        const Vec2 point = axes.of(in_space(surface, t, x, end));
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
      }
  if (low.x() > high.x()) return {};
  const Vec2 middle = 0.5 * (low + high);
  return Vec3(axes.origin + middle.x() * axes.u + middle.y() * axes.v);
}

std::optional<double> body_girth(const Surface& surface, const Points& x, const CutPlane& plane, const Vec3& middle) {
  const PlaneAxes axes(plane, middle);
  std::vector<Vec2> points;
  for (const CutLoop& loop : closed_loops(surface, 0, static_cast<int>(surface.triangles.rows()), x, plane))
    if (goes_round_origin(surface, loop, x, axes))
      for (const CutTriangle& cut : loop)
        for (const Vec3& end : cut.ends) points.push_back(axes.of(in_space(surface, cut.triangle, x, end)));
  return points.size() > 2 ? std::optional(hull_length(points)) : std::nullopt;
}

std::optional<double> girth_at_rest(const Scene& scene, const Cloth& cloth, const Points& x, const CutPlane& plane,
                                    const Vec3& middle) {
  const PlaneAxes axes(plane, middle);
  double length = 0;
  for (const CutLoop& loop : closed_loops(scene.surface, cloth.first_triangle, cloth.triangle_count, x, plane))
    if (goes_round_origin(scene.surface, loop, x, axes))
      for (const CutTriangle& cut : loop)
        length += (scene.rest_triangle[cut.triangle] * (cut.ends[1] - cut.ends[0])).norm();
  return length > 0 ? std::optional(length) : std::nullopt;
}

}  // namespace selvedge
