#include "collision/exact/moving_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace selvedge {
namespace {

// Takes differences of nodes, scaled by the power of two `shrink`. Returns the largest coordinate.
double take_differences(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1, double shrink,
                        MovingPolygon& p) {
  double largest = 0;
  p.corners = 0;
  for (const CornerNodes& nodes : polygon_corners(kind)) {
    const Vec3 start = shrink * x0[nodes.to] - shrink * x0[nodes.from];
    const Vec3 end = shrink * x1[nodes.to] - shrink * x1[nodes.from];
    largest = std::max({largest, start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()});
    p.start[p.corners] = start;
    p.end[p.corners] = end;
    ++p.corners;
  }
  return largest;
}

}  // namespace

std::span<const CornerNodes> polygon_corners(PairKind kind) {
  static constexpr std::array<CornerNodes, 3> triangle{{{0, 1}, {0, 2}, {0, 3}}};
  static constexpr std::array<CornerNodes, 4> parallelogram{{{0, 2}, {1, 2}, {1, 3}, {0, 3}}};
  if (kind == PairKind::vertex_face) return triangle;
  return parallelogram;
}

MovingPolygon moving_polygon(PairKind kind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1) {
  constexpr double smallest = std::numeric_limits<double>::min(), huge = 0.125 * std::numeric_limits<double>::max();
  MovingPolygon p;
  double largest = take_differences(kind, x0, x1, 1, p), shrink = 1;
  if (!(largest < huge)) {
    shrink = 1.0 / 16;
    largest = take_differences(kind, x0, x1, shrink, p);
  }
  const double scale = largest < smallest ? 1 : std::ldexp(1.0, -std::ilogb(largest));
  for (int k = 0; k < p.corners; ++k) {
    p.start[k] *= scale;
    p.end[k] *= scale;
  }
  p.scale = shrink * scale;
  return p;
}

}  // namespace selvedge
