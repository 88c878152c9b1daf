#pragma once

#include <array>
#include <span>

#include "collision/geometry/points.hpp"

namespace selvedge {

enum class PairKind { vertex_face, edge_edge };  // nodes v, f0, f1, f2 | a0, a1, b0, b1

constexpr int most_corners = 4;

// A corner is the difference x[to] - x[from] of two nodes.
struct CornerNodes {
  int from, to;
};

// In cyclic order.
std::span<const CornerNodes> polygon_corners(PairKind);

// What continuous detection looks at: all differences of a point of the second primitive and one of the first (their
// Minkowski difference). They form a flat convex polygon, a triangle f_k - v or a parallelogram b_j - a_i. Its distance
// from the origin is that of the primitives, and it holds the origin where they meet. Corners move straight where the
// nodes do.
struct MovingPolygon {
  int corners = 0;
  std::array<Vec3, most_corners> start, end;  // at times 0 and 1
  double scale = 1;  // all coordinates are multiplied by this power of two, which brings them below two

  Vec3 at(int corner, double time) const { return (1 - time) * start[corner] + time * end[corner]; }
};

// Coordinates of start and end are differences, rounded once (relative error u, or underflow). x0, x1 must be finite.
MovingPolygon moving_polygon(PairKind, const std::array<Vec3, 4>& x0, const std::array<Vec3, 4>& x1);

}  // namespace selvedge
