#include "collision/geometry/distance.hpp"

#include <array>
#include <limits>

namespace selvedge {
namespace {

// A triangle or a pair of edges counts as flat if the squared sine of its angle is below this. The cross product then
// has lost so many digits that the closest points of the boundary are tried as well.
constexpr double flat = 1e-10;

struct OnSegment {
  double squared_distance, parameter;
};

OnSegment point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length2 = ab.squaredNorm(), along = ap.dot(ab);
  if (!(along > 0) || !(length2 > 0)) return {ap.squaredNorm(), 0};
  if (along >= length2) return {(p - b).squaredNorm(), 1};
  const double s = along / length2;
  return {(ap - s * ab).squaredNorm(), s};
}

void take_nearer(Closest& best, double squared_distance, const Eigen::Vector4d& weights) {
  if (squared_distance < best.squared_distance) best = {squared_distance, weights};
}

}  // namespace

Closest point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = ab.cross(ac);
  const double normal2 = normal.squaredNorm(), ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm();
  Closest best{std::numeric_limits<double>::infinity(), {1, -1, 0, 0}};
  if (normal2 > 0) {
    const double wb = ap.cross(ac).dot(normal) / normal2, wc = ab.cross(ap).dot(normal) / normal2;
    if (wb >= 0 && wc >= 0 && wb + wc <= 1) {
      best = {(ap - wb * ab - wc * ac).squaredNorm(), {1, -(1 - wb - wc), -wb, -wc}};
      if (normal2 > flat * ab2 * ac2) return best;
    }
  }
  const std::array<const Vec3*, 3> corner{&a, &b, &c};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const OnSegment near = point_segment(p, *corner[k], *corner[next]);
    if (!(near.squared_distance < best.squared_distance)) continue;
    best.squared_distance = near.squared_distance;
    best.weights.setZero();
    best.weights[0] = 1;
    best.weights[1 + k] = near.parameter - 1;
    best.weights[1 + next] = -near.parameter;
  }
  return best;
}

Closest edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, r = b0 - a0;
  const Vec3 normal = u.cross(v);
  const double normal2 = normal.squaredNorm();
  Closest best{std::numeric_limits<double>::infinity(), {1, 0, -1, 0}};
  if (normal2 > 0) {
    const double s = r.cross(v).dot(normal) / normal2, t = r.cross(u).dot(normal) / normal2;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) {
      best = {(r + t * v - s * u).squaredNorm(), {1 - s, s, t - 1, -t}};
      if (normal2 > flat * u.squaredNorm() * v.squaredNorm()) return best;
    }
  }
  const OnSegment from_a0 = point_segment(a0, b0, b1), from_a1 = point_segment(a1, b0, b1);
  const OnSegment from_b0 = point_segment(b0, a0, a1), from_b1 = point_segment(b1, a0, a1);
  take_nearer(best, from_a0.squared_distance, {1, 0, from_a0.parameter - 1, -from_a0.parameter});
  take_nearer(best, from_a1.squared_distance, {0, 1, from_a1.parameter - 1, -from_a1.parameter});
  take_nearer(best, from_b0.squared_distance, {1 - from_b0.parameter, from_b0.parameter, -1, 0});
  take_nearer(best, from_b1.squared_distance, {1 - from_b1.parameter, from_b1.parameter, 0, -1});
  return best;
}

}  // namespace selvedge
