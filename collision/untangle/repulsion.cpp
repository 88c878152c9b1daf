#include "collision/untangle/repulsion.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/distance.hpp"
#include "collision/geometry/stop_scope.hpp"

namespace selvedge {
namespace {

std::vector<const Surface*> surfaces_of(std::span<const SheetView> obstacles) {
  std::vector<const Surface*> surfaces;
  for (const SheetView& obstacle : obstacles) surfaces.push_back(obstacle.surface);
  return surfaces;
}

}  // namespace

Repulsion::Repulsion(const Surface& cloth, std::span<const SheetView> obstacles, const InputShape& shape)
    : shape_(shape), world_(make_contact_world(cloth, surfaces_of(obstacles), true)), search_(world_) {
  for (const SheetView& obstacle : obstacles) obstacle_points_.push_back(*obstacle.x);
  input_ = gather_nodes(shape.x0, obstacle_points_);
}

// Does an edge join a vertex of one primitive to a vertex of the other?
bool Repulsion::neighbours(const NodePair& pair) const {
  const int first = pair.kind == PairKind::vertex_face ? 1 : 2;
  for (int i = 0; i < first; ++i) {
    const int v = pair.nodes[i];
    if (!world_.is_cloth(v)) return false;
    for (int j = first; j < 4; ++j)
      if (std::ranges::binary_search(shape_.neighbours.of(v), pair.nodes[j])) return true;
  }
  return false;
}

bool Repulsion::is_movable(const NodePair& pair, const std::vector<double>& reach) const {
  return std::ranges::any_of(pair.nodes, [&](int node) { return world_.is_cloth(node) && reach[node] > 0; });
}

// Is one of the primitives (with an obstacle: that of the cloth) away from contours and enclosed regions? wide: are
// both?
bool Repulsion::is_clear(const NodePair& pair, const std::vector<char>& tangled, bool wide) const {
  const int first = pair.kind == PairKind::vertex_face ? 1 : 2;
  std::array<bool, 2> clear{true, true};
  for (int i = 0; i < 4; ++i)
    if (world_.is_cloth(pair.nodes[i]) ? tangled[pair.nodes[i]] != 0 : !wide) clear[i < first ? 0 : 1] = false;
  return wide ? clear[0] && clear[1] : clear[0] || clear[1];
}

std::vector<Separation> Repulsion::find(const Points& x, const std::vector<char>& tangled,
                                        const std::vector<double>& reach, double gap, double horizon, bool wide) {
  const Points nodes = gather_nodes(x, obstacle_points_);
  search_.find(nodes, nodes, horizon, pairs_);
  std::vector<Separation> separations;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (k % 4096 == 0) check_stop();
    const NodePair& pair = pairs_[k];
    if (!is_movable(pair, reach) || !is_clear(pair, tangled, wide)) continue;
    const Closest now = closest(pair, nodes);
    const double distance = std::sqrt(now.squared_distance);
    if (distance >= horizon || distance == 0) continue;
    double least = gap;
    if (neighbours(pair)) {
      const Closest input = closest(pair, input_);
      least = std::min(gap, 0.7 * std::sqrt(input.squared_distance));
    }
    Separation separation;
    separation.least = least;
    separation.direction = Vec3::Zero();
    for (int i = 0; i < 4; ++i) separation.direction += now.weights[i] * row(nodes, pair.nodes[i]);
    separation.direction /= distance;
    for (int i = 0; i < 4; ++i) {
      const int node = pair.nodes[i];
      if (world_.is_cloth(node)) {
        separation.vertex[separation.count] = node;
        separation.weight[separation.count++] = now.weights[i];
      } else {
        separation.least -= now.weights[i] * separation.direction.dot(row(nodes, node));
      }
    }
    separations.push_back(separation);
  }
  return separations;
}

}  // namespace selvedge
