#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// Closest points p and q of two primitives. The vector from q to p is sum w_i x_i with the `weights` w, over the four
// nodes x_i in the order of the arguments: weights are positive on the first primitive, negative on the second.
struct Closest {
  double squared_distance = 0;
  Eigen::Vector4d weights;
};

// Nodes p, a, b, c. Weights (1, -wa, -wb, -wc) with wa + wb + wc = 1, all >= 0. Degenerate triangles are handled as
// their longest edge or as a point.
Closest point_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

// Nodes a0, a1, b0, b1. Weights (1 - s, s, -(1 - t), -t) with s, t in [0, 1]. Parallel and degenerate edges give one of
// the closest pairs, always the same one.
Closest edge_edge(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

}  // namespace selvedge
