#include "physics/recovery/carried_along.hpp"

#include <algorithm>

#include "collision/geometry/factorisations.hpp"
#include "collision/geometry/nearest_point.hpp"

namespace selvedge {

std::vector<int> nearest_obstacle_nodes(const ContactWorld& world, const Points& nodes, const Points& places) {
  const Eigen::Index first = world.cloth->vertex_count;
  const Points obstacles = nodes.bottomRows(nodes.rows() - first);
  const CellGrid grid = grid_of(obstacles);
  std::vector<int> nearest;
  for (Eigen::Index k = 0; k < places.rows(); ++k)
    nearest.push_back(static_cast<int>(first) + nearest_point(grid, obstacles, places.row(k).transpose()).point);
  return nearest;
}

Points carried_along(const ContactWorld& world, const Points& before, const Points& nodes, double thickness) {
  const Surface& cloth = *world.cloth;
  const Points x = before.topRows(cloth.vertex_count);
  const double edge = mean_edge(cloth, x);
  std::vector<Eigen::Triplet<double>> entries;
  Points pull(cloth.vertex_count, 3);
  const std::vector<int> nearest = nearest_obstacle_nodes(world, before, x);
  for (int v = 0; v < cloth.vertex_count; ++v) {
    const int node = nearest[v];
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
