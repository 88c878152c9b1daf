#include "collision/search/intersections.hpp"

#include <algorithm>
#include <limits>

#include "collision/exact/triangle_pair.hpp"
#include "collision/geometry/corners.hpp"

namespace selvedge {
namespace {

using Pairs = std::vector<std::pair<int, int>>;
using Corners = std::array<Vec3, 3>;

bool all_finite(const Corners& c) { return c[0].allFinite() && c[1].allFinite() && c[2].allFinite(); }

bool intersect(const Corners& a, const Corners& b) {
  return !surely_apart(a, b) && all_finite(a) && all_finite(b) && triangles_meet(a, b);
}

struct Range {
  double low, high;
};

Range range_along(const Vec3& m, const Corners& c) {
  const double p = m.dot(c[0]), q = m.dot(c[1]), r = m.dot(c[2]);
  return {std::min(std::min(p, q), r), std::max(std::max(p, q), r)};
}

// A bound of the rounding error of a difference of two products m . p. Points are relative to one of them; each
// coordinate is wrong by at most u = 2^-53 of itself, and coordinates sum to at most `reach`. With the rounding of
// three products and two sums m . p is wrong by less than 5 u max |m_k| reach, both sides together by 10 u; 2e-15 is 18
// u. Underflow adds less than 1e-300.
double slack_along(const Vec3& m, double reach) { return 2e-15 * m.cwiseAbs().maxCoeff() * reach + 1e-300; }

// Is there a plane perpendicular to m between the two triangles?
bool apart_along(const Vec3& m, const Corners& a, const Corners& b, double reach) {
  const Range of_a = range_along(m, a), of_b = range_along(m, b);
  return std::max(of_b.low - of_a.high, of_a.low - of_b.high) > slack_along(m, reach);
}

// A bound of the rounding error of a height over a face's plane. With R for `reach`, the computed normal is wrong by
// less than 3 u 4 R^2 in each coordinate, which along an edge (2 R) of the face gives 24 u R^3; the edges' own error of
// 4 u R in the sum of their coordinates adds 16 u R^3. The face's other corners may be off the plane by this much;
// 1e-14 is 90 u.
double slack_by_plane(const Vec3& normal, double reach) {
  return slack_along(normal, reach) + 1e-14 * reach * reach * reach;
}

// Is the other triangle on one side of the face's plane through its corner `on`?
bool apart_by_plane(const Vec3& normal, const Vec3& on, const Corners& other, double reach) {
  const Range beyond = range_along(normal, other);
  const double height = normal.dot(on), slack = slack_by_plane(normal, reach);
  return std::max(beyond.low - height, height - beyond.high) > slack;
}

bool apart_beside(const Vec3& normal, const Corners& face, const Corners& other, double reach) {
  for (int k = 0; k < 3; ++k)
    if (apart_along((face[(k + 1) % 3] - face[k]).cross(normal), face, other, reach)) return true;
  return false;
}

// True if the tree was built anew.
bool refresh(const Surface& surface, const Points& x, IntersectionCache& cache) {
  triangle_boxes(surface, x, x, 0, cache.boxes);
  return update(cache.tree, cache.boxes);
}

}  // namespace

bool surely_apart(const Corners& first, const Corners& second) {
  Corners a, b;
  double reach = 0;
  for (int k = 0; k < 3; ++k) {
    a[k] = first[k] - first[0];
    b[k] = second[k] - first[0];
    reach = std::max({reach, a[k].cwiseAbs().sum(), b[k].cwiseAbs().sum()});
  }
  const Vec3 normal_a = a[1].cross(a[2]);
  if (apart_by_plane(normal_a, a[0], b, reach)) return true;
  const Vec3 normal_b = (b[1] - b[0]).cross(b[2] - b[0]);
  if (apart_by_plane(normal_b, b[0], a, reach)) return true;
  return apart_beside(normal_a, a, b, reach) || apart_beside(normal_b, b, a, reach);
}

FacePlane face_plane(const Corners& face) {
  const Vec3 p = face[1] - face[0], q = face[2] - face[0];
  return {face[0], p.cross(q), std::max(p.cwiseAbs().sum(), q.cwiseAbs().sum())};
}

bool surely_on_one_side(const FacePlane& plane, std::span<const Vec3> points) {
  double reach = plane.reach, low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vec3& point : points) {
    const Vec3 p = point - plane.on;
    reach = std::max(reach, p.cwiseAbs().sum());
    const double height = plane.normal.dot(p);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return std::max(low, -high) > slack_by_plane(plane.normal, reach);
}

Pairs intersecting_pairs(const Surface& surface, const Points& x, IntersectionCache& cache) {
  const bool rebuilt = refresh(surface, x, cache);
  const Bvh& tree = cache.tree.bvh;
  if (cache.cull) {
    if (rebuilt || cache.parts.part_of.size() != tree.nodes.size()) find_parts(surface, tree, cache.parts);
    mark_quiet(surface, x, tree, cache.parts);
  }
  const BvhTraversal traversal{tree, tree, true, cache.cull ? &cache.parts.quiet : nullptr};
  Pairs pairs;
  gather_pairs(traversal, cache.lists, pairs, [&](int s, int t, Pairs& found) {
    if (!share_vertex(surface.triangles, s, t) && intersect(corners_of(surface, x, s), corners_of(surface, x, t)))
      found.emplace_back(std::min(s, t), std::max(s, t));
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs intersecting_pairs(const Surface& first, const Points& x_first, IntersectionCache& cache_first,
                         const Surface& second, const Points& x_second, IntersectionCache& cache_second) {
  refresh(first, x_first, cache_first);
  refresh(second, x_second, cache_second);
  const BvhTraversal traversal{cache_first.tree.bvh, cache_second.tree.bvh, false};
  Pairs pairs;
  gather_pairs(traversal, cache_first.lists, pairs, [&](int s, int t, Pairs& found) {
    if (intersect(corners_of(first, x_first, s), corners_of(second, x_second, t))) found.emplace_back(s, t);
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace selvedge
