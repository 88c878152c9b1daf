#include "physics/recovery/carried_along.hpp"

#include <algorithm>
#include <vector>

#include "collision/geometry/factorisations.hpp"

namespace selvedge {

int nearest_obstacle_node(const ContactWorld& world, const Points& nodes, const Vec3& place) {
  const Eigen::Index first = world.cloth->vertex_count;
  Eigen::Index nearest = 0;
  (nodes.bottomRows(nodes.rows() - first).rowwise() - place.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(first + nearest);
}

Points carried_along(const ContactWorld& world, const Points& before, const Points& nodes, double thickness) {
  const Surface& cloth = *world.cloth;
  const Points x = before.topRows(cloth.vertex_count);
  const double edge = mean_edge(cloth, x);
  std::vector<Eigen::Triplet<double>> entries;
  Points pull(cloth.vertex_count, 3);
  for (int v = 0; v < cloth.vertex_count; ++v) {
    const int node = nearest_obstacle_node(world, before, row(x, v));
    const double d = std::max((before.row(node) - x.row(v)).norm(), thickness);
    const double weight = edge * edge / (d * d);
    entries.emplace_back(v, v, weight);
    pull.row(v) = weight * (nodes.row(node) - before.row(node));
  }
  for (Eigen::Index e = 0; e < cloth.edges.rows(); ++e) {
    const int a = cloth.edges(e, 0), b = cloth.edges(e, 1);
    entries.emplace_back(a, a, 1);
    entries.emplace_back(b, b, 1);
    entries.emplace_back(std::max(a, b), std::min(a, b), -1);
  }
  Eigen::SparseMatrix<double> matrix(cloth.vertex_count, cloth.vertex_count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return x + solve_symmetric(matrix, pull);
}

}  // namespace selvedge
