#include "physics/energies/joints.hpp"

#include <algorithm>

#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {

double joint_energy(const Spring& spring, const Points& x) {
  const double stretch = (row(x, spring.b) - row(x, spring.a)).norm() - spring.rest_length;
  return 0.5 * spring.stiffness * stretch * stretch;
}

double joint_derivatives(const Spring& spring, const Points& x, Vec6& gradient, Mat6* hessian, bool psd) {
  const Vec3 between = row(x, spring.b) - row(x, spring.a);
  const double length = between.norm(), stretch = length - spring.rest_length;
  const bool directed = length > 0;
  const Vec3 direction = directed ? Vec3(between / length) : Vec3::Zero();
  const Vec3 force = spring.stiffness * stretch * direction;
  gradient << -force, force;
  if (hessian) {
    const double across = directed ? stretch / length : 1;
    const double tangential = spring.stiffness * (psd ? std::max(across, 0.0) : across);
    const Mat3 block = tangential * Mat3::Identity() +
                       (directed ? spring.stiffness - tangential : 0) * direction * direction.transpose();
    *hessian << block, -block, -block, block;
  }
  return 0.5 * spring.stiffness * stretch * stretch;
}

std::vector<int> joined_parts(const Scene& scene, std::span<const int> part_of_vertex, int parts,
                              std::span<const char> there) {
  DisjointSets sets(parts);
  for_each_joint_list([&](auto list, const JointKind&) {
    for (const auto& joint : scene.*list) {
      const auto nodes = nodes_of(joint);
      if (!there.empty() && std::ranges::any_of(nodes, [&](int node) { return !there[node]; })) continue;
      for (const int node : nodes) sets.join(part_of_vertex[nodes[0]], part_of_vertex[node]);
    }
  });
  std::vector<int> joined(static_cast<std::size_t>(parts));
  for (int part = 0; part < parts; ++part) joined[part] = sets.root(part);
  return joined;
}

std::vector<int> joined_components(const Scene& scene) {
  const std::vector<int>& component = scene.surface.component;
  const std::vector<int> joined = joined_parts(scene, component, scene.surface.component_count);
  std::vector<int> of_vertex;
  for (const int c : component) of_vertex.push_back(joined[c]);
  return of_vertex;
}

}  // namespace selvedge
