#include "pipeline/measures/fit_girth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace selvedge {
namespace {

// Where a plane cuts a triangle: on two of its sides, as weights of its corners.
using SectionEnds = std::array<Vec3, 2>;

std::optional<SectionEnds> section_of(const std::array<double, 3>& heights) {
  SectionEnds ends;
  int count = 0;
  for (int k = 0; k < 3 && count < 2; ++k) {
    const double a = heights[k], b = heights[(k + 1) % 3];
    if ((a < 0) == (b < 0)) continue;
    ends[count] = Vec3::Zero();
    ends[count][k] = b / (b - a);
    ends[count][(k + 1) % 3] = -a / (b - a);
    ++count;
  }
  return count == 2 ? std::optional(ends) : std::nullopt;
}

std::optional<SectionEnds> section_of(const Triangles& triangles, int t, const Points& x, const CutPlane& plane) {
  std::array<double, 3> heights;
  for (int k = 0; k < 3; ++k) heights[k] = plane.normal.dot(row(x, triangles(t, k))) - plane.offset;
  return section_of(heights);
}

// Two directions that span the plane.
Eigen::Matrix<double, 3, 2> spanned(const Vec3& normal) {
  Eigen::Matrix<double, 3, 2> span;
  span.col(0) = normal.unitOrthogonal();
  span.col(1) = normal.cross(span.col(0));
  return span;
}

Vec3 in_space(const Triangles& triangles, int t, const Points& x, const Vec3& weights) {
  return weights[0] * row(x, triangles(t, 0)) + weights[1] * row(x, triangles(t, 1)) +
         weights[2] * row(x, triangles(t, 2));
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

std::optional<BodyGirth> body_girth(const Triangles& triangles, const std::vector<int>& which, const Points& x,
                                    const CutPlane& plane) {
  const Eigen::Matrix<double, 3, 2> span = spanned(plane.normal);
  std::vector<Vec2> points;
  Vec2 low = Vec2::Constant(INFINITY), high = -low;
  for (const int t : which)
    if (const auto ends = section_of(triangles, t, x, plane))
      for (const Vec3& weights : *ends) {
        points.push_back(span.transpose() * in_space(triangles, t, x, weights));
        low = low.cwiseMin(points.back());
        high = high.cwiseMax(points.back());
      }
  if (points.size() < 3) return {};
  return BodyGirth{hull_length(points), span * (0.5 * (low + high)) + plane.offset * plane.normal};
}

std::optional<double> girth_at_rest(const Triangles& triangles, const std::vector<RestTriangle>& rest,
                                    const std::vector<int>& which, const Points& x, const CutPlane& plane,
                                    const Vec3& middle) {
  constexpr int sectors = 36, most_empty = 3;
  const Eigen::Matrix<double, 3, 2> span = spanned(plane.normal);
  const auto sector_of = [&](const Vec3& point) {
    const Vec2 away = span.transpose() * (point - middle);
    const double angle = std::atan2(away.y(), away.x()) + std::numbers::pi;
    return std::min(sectors - 1, static_cast<int>(sectors * angle / (2 * std::numbers::pi)));
  };
  std::array<bool, sectors> seen{};
  double length = 0;
  for (const int t : which) {
    const auto ends = section_of(triangles, t, x, plane);
    if (!ends) continue;
    length += (rest[t] * ((*ends)[1] - (*ends)[0])).norm();
    for (int k = 0; k <= 8; ++k)  // a long segment covers sectors between its ends too
      seen[sector_of(in_space(triangles, t, x, (k * (*ends)[1] + (8 - k) * (*ends)[0]) / 8))] = true;
  }
  int empty = 0, longest = 0;
  for (int k = 0; k < 2 * sectors; ++k) {
    empty = seen[k % sectors] ? 0 : empty + 1;
    longest = std::max(longest, empty);
  }
  return longest <= most_empty ? std::optional(length) : std::nullopt;
}

}  // namespace selvedge
