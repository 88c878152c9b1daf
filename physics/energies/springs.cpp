#include "physics/energies/springs.hpp"

#include <algorithm>

#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {

double spring_energy(const Spring& spring, const Points& x) {
  const double stretch = (row(x, spring.b) - row(x, spring.a)).norm() - spring.rest_length;
  return 0.5 * spring.stiffness * stretch * stretch;
}

double spring_derivatives(const Spring& spring, const Points& x, Vec6& gradient, Mat6* hessian, bool psd) {
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

std::vector<int> joined_by_springs(std::span<const Spring> springs, std::span<const int> part_of_vertex, int parts) {
  DisjointSets sets(parts);
  for (const Spring& spring : springs) sets.join(part_of_vertex[spring.a], part_of_vertex[spring.b]);
  std::vector<int> joined(static_cast<std::size_t>(parts));
  for (int part = 0; part < parts; ++part) joined[part] = sets.root(part);
  return joined;
}

std::vector<int> joined_components(const Scene& scene) {
  const std::vector<int>& component = scene.surface.component;
  const std::vector<int> joined = joined_by_springs(scene.springs, component, scene.surface.component_count);
  std::vector<int> of_vertex;
  for (const int c : component) of_vertex.push_back(joined[c]);
  return of_vertex;
}

}  // namespace selvedge
