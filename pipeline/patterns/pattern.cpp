#include "pipeline/patterns/pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

constexpr int fine_pieces = 512;  // pieces of a curve, for measuring lengths

const Vec2& corner(const Panel& panel, const PanelEdge& edge, std::size_t end) { return panel.corners[edge.ends[end]]; }

// t from 0 to 1, by equal angles.
Vec2 arc_point(const Vec2& a, const Vec2& b, const PanelEdge& edge, double t) {
  const double chord = (b - a).norm(), radius = std::max(edge.radius, chord / 2);
  const Vec2 left = Vec2(a.y() - b.y(), b.x() - a.x()) / chord;
  // The centre of a short arc that turns left lies left of its chord; of a long one, right.
  const double side = edge.counterclockwise == edge.large_arc ? -1 : 1;
  const Vec2 centre = (a + b) / 2 + side * std::sqrt(std::max(0.0, radius * radius - chord * chord / 4)) * left;
  const double half = std::asin(std::min(1.0, chord / (2 * radius)));
  const double pi = 3.14159265358979323846, angle = edge.large_arc ? 2 * (pi - half) : 2 * half;
  return centre + Eigen::Rotation2Dd((edge.counterclockwise ? t : -t) * angle) * (a - centre);
}

Vec2 curve_point(const Panel& panel, const PanelEdge& edge, double t) {
  const Vec2 &a = corner(panel, edge, 0), &b = corner(panel, edge, 1);
  const double s = 1 - t;
  switch (edge.form) {
    case EdgeForm::quadratic:
      return s * s * a + 2 * s * t * edge.controls[0] + t * t * b;
    case EdgeForm::cubic:
      return s * s * s * a + 3 * s * s * t * edge.controls[0] + 3 * s * t * t * edge.controls[1] + t * t * t * b;
    case EdgeForm::circle:
      return arc_point(a, b, edge, t);
    case EdgeForm::straight:
      break;
  }
  return s * a + t * b;
}

struct FineCurve {
  std::vector<Vec2> points;
  std::vector<double> length;  // up to each [m]
};

FineCurve fine_curve(const Panel& panel, const PanelEdge& edge) {
  FineCurve curve;
  for (int i = 0; i <= fine_pieces; ++i) {
    curve.points.push_back(curve_point(panel, edge, static_cast<double>(i) / fine_pieces));
    curve.length.push_back(i == 0 ? 0 : curve.length.back() + (curve.points.back() - curve.points.end()[-2]).norm());
  }
  return curve;
}

}  // namespace

std::string edge_name(const Panel& panel, int edge) { return fmt::format("panel `{}`, edge {}", panel.name, edge); }

double edge_length(const Panel& panel, int e) {
  const PanelEdge& edge = panel.edges[e];
  if (edge.form == EdgeForm::straight) return (corner(panel, edge, 1) - corner(panel, edge, 0)).norm();
  return fine_curve(panel, edge).length.back();
}

std::vector<Vec2> edge_points(const Panel& panel, int e, int n) {
  const PanelEdge& edge = panel.edges[e];
  const FineCurve curve = fine_curve(panel, edge);
  std::vector<Vec2> points{corner(panel, edge, 0)};
  for (int i = 1; i < n; ++i) {
    const double wanted = curve.length.back() * i / n;
    const auto after = static_cast<std::size_t>(std::ranges::upper_bound(curve.length, wanted) - curve.length.begin());
    const double span = curve.length[after] - curve.length[after - 1];
    const double share = span > 0 ? (wanted - curve.length[after - 1]) / span : 0;
    points.push_back((1 - share) * curve.points[after - 1] + share * curve.points[after]);
  }
  points.push_back(corner(panel, edge, 1));
  return points;
}

}  // namespace selvedge
