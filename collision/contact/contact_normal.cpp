#include "collision/contact/contact_normal.hpp"

#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>

namespace selvedge {
namespace {

constexpr double rounding = 1e-12;  // of a direction
constexpr double across = 0.1;      // least cosine with `direction`: normals with a smaller one are not used

// Positions during the motion.
struct Moving {
  const Points &x0, &x1;
  double time;
  Vec3 operator()(int node) const { return row(x0, node) + time * (row(x1, node) - row(x0, node)); }
};

// The vertex or the edge of a surface on which the closest point of one side of a pair lies.
struct Feature {
  const Surface* surface;
  int first_node;            // of the surface
  std::array<int, 2> nodes;  // its nodes; for a vertex the second is -1
};

Feature feature_of(const ContactWorld& world, std::array<int, 2> nodes) {
  const int obstacle = world.obstacle_of(nodes[0]);
  return {obstacle < 0 ? world.cloth : world.obstacles[obstacle], obstacle < 0 ? 0 : world.first_node[obstacle], nodes};
}

// `direction` (unit, away from the feature) if no face at the feature is on that side of it. Otherwise the nearest
// normal of these faces, or `direction` again if it is nearly perpendicular to all normals.
Vec3 in_cone(const Feature& feature, const Vec3& direction, const Moving& x) {
  const auto [a, b] = feature.nodes;
  const bool vertex = b < 0;
  const Vec3 at = x(a), edge = vertex ? Vec3(Vec3::Zero()) : Vec3((x(b) - at).normalized());
  bool closest = true;
  double best = across;
  Vec3 found = direction;
  for (const int t : feature.surface->triangles_of(a - feature.first_node)) {
    std::array<Vec3, 3> corner;
    bool has_edge = vertex;
    for (int k = 0; k < 3; ++k) {
      const int node = feature.first_node + feature.surface->triangles(t, k);
      corner[k] = x(node);
      has_edge = has_edge || node == b;
      if (vertex && node != a) closest = closest && direction.dot((corner[k] - at).normalized()) <= rounding;
    }
    if (!has_edge) continue;
    if (!vertex)
      for (int k = 0; k < 3; ++k) {
        Vec3 inward = corner[k] - at;  // zero up to rounding for the edge's own ends
        inward -= inward.dot(edge) * edge;
        const int node = feature.first_node + feature.surface->triangles(t, k);
        if (node != a && node != b) closest = closest && direction.dot(inward.normalized()) <= rounding;
      }
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    const double cosine = normal.dot(direction);
    if (!(std::abs(cosine) > best)) continue;
    best = std::abs(cosine);
    found = cosine > 0 ? normal : Vec3(-normal);
  }
  return closest ? direction : found;
}

// The vertex or edge on which the closest point of one side of a pair lies; none if it is inside a face.
std::optional<std::array<int, 2>> ends_of(const NodePair& pair, const Eigen::Vector4d& weights,
                                          std::initializer_list<int> side) {
  std::array<int, 2> ends{-1, -1};
  std::size_t count = 0;
  for (const int i : side) {
    if (weights[i] == 0) continue;
    if (count == ends.size()) return {};
    ends[count++] = pair.nodes[static_cast<std::size_t>(i)];
  }
  return ends;
}

}  // namespace

Vec3 contact_normal(const ContactWorld& world, const NodePair& pair, const Eigen::Vector4d& weights,
                    const Vec3& between, const Points& x0, const Points& x1, double time) {
  const Vec3 direction = between.normalized();
  const Moving x{x0, x1, time};
  const bool edges = pair.kind == PairKind::edge_edge;
  if (!world.is_cloth(pair.nodes[0])) {
    const auto ends = edges ? ends_of(pair, weights, {0, 1}) : ends_of(pair, weights, {0});
    return -in_cone(feature_of(world, *ends), -direction, x);
  }
  if (!world.is_cloth(pair.nodes[3]))
    if (const auto ends = edges ? ends_of(pair, weights, {2, 3}) : ends_of(pair, weights, {1, 2, 3}))
      return in_cone(feature_of(world, *ends), direction, x);
  return direction;
}

}  // namespace selvedge
