#include "collision/contact/node_pair.hpp"

namespace selvedge {

std::array<Vec3, 4> corners(const NodePair& pair, const Points& x) {
  return {row(x, pair.nodes[0]), row(x, pair.nodes[1]), row(x, pair.nodes[2]), row(x, pair.nodes[3])};
}

Closest closest(PairKind kind, const std::array<Vec3, 4>& x) {
  return kind == PairKind::vertex_face ? point_triangle(x[0], x[1], x[2], x[3]) : edge_edge(x[0], x[1], x[2], x[3]);
}

}  // namespace selvedge
