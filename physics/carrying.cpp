#include "physics/carrying.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "collision/cell_grid.hpp"
#include "collision/distance.hpp"

namespace selvedge {
namespace {

// Marks the cloth near the triangles of which all corners are switched off.
void add_near(const ContactWorld& world, const std::vector<char>& off, const Points& nodes, double reach,
              std::vector<char>& carried) {
  const CellGrid grid(nodes.topRows(world.cloth->vertex_count), reach);
  for (std::size_t k = 0; k < world.obstacles.size(); ++k)
    for (const auto& triangle : world.obstacles[k]->triangles.rowwise()) {
      std::array<Vec3, 3> corners;
      bool all = true;
      for (int c = 0; c < 3; ++c) {
        const int node = world.first_node[k] + triangle[c];
        all = all && off[node];
        corners[c] = row(nodes, node);
      }
      if (!all) continue;
      const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3;
      double radius = 0;
      for (const Vec3& corner : corners) radius = std::max(radius, (corner - middle).norm());
      grid.for_each_near(middle, radius + reach, [&](int v) {
        const Closest closest = point_triangle(row(nodes, v), corners[0], corners[1], corners[2]);
        if (closest.squared_distance < reach * reach) carried[v] = 1;
      });
    }
}

}  // namespace

std::vector<char> carried_vertices(const ContactWorld& world, const Exemption& exemption, const Points& worn,
                                   const Points& nodes, double reach) {
  if (worn.rows() == 0 || exemption.off.empty()) return {};
  std::vector<char> carried(static_cast<std::size_t>(worn.rows()), 0);
  add_near(world, exemption.off, nodes, reach, carried);
  for (std::size_t v = 0; v < carried.size(); ++v)
    carried[v] = carried[v] && worn.row(static_cast<Eigen::Index>(v)).allFinite();
  return std::ranges::find(carried, 1) == carried.end() ? std::vector<char>() : carried;
}

AddedTerm carrying_term(const std::vector<char>& carried, const Eigen::VectorXd& masses, const Points& x0,
                        const Points& worn, double way, double h) {
  struct Pull {
    int vertex;
    Vec3 target;
    double stiffness;  // [N/m]
  };
  const auto pulls = std::make_shared<std::vector<Pull>>();
  for (int v = 0; v < static_cast<int>(carried.size()); ++v) {
    if (!carried[v]) continue;
    const Vec3 whole = row(worn, v) - row(x0, v);
    pulls->push_back({v, row(x0, v) + std::min(1.0, way / whole.norm()) * whole, masses[v] / (h * h)});
  }
  return {[pulls](const Points& x) {
            double energy = 0;
            for (const Pull& s : *pulls) energy += 0.5 * s.stiffness * (row(x, s.vertex) - s.target).squaredNorm();
            return energy;
          },
          [pulls](const Points& x, Points& gradient, std::vector<ContactBlock>& blocks) {
            for (const Pull& s : *pulls) {
              gradient.row(s.vertex) += s.stiffness * (row(x, s.vertex) - s.target).transpose();
              blocks.push_back({{s.vertex, -1, -1, -1}, {1, 0, 0, 0}, Vec3::UnitY(), s.stiffness, s.stiffness});
            }
          }};
}

AddedTerm sum_of(AddedTerm a, AddedTerm b) {
  if (!a.value) return b;
  if (!b.value) return a;
  const auto both = std::make_shared<const std::pair<AddedTerm, AddedTerm>>(std::move(a), std::move(b));
  return {[both](const Points& x) { return both->first.value(x) + both->second.value(x); },
          [both](const Points& x, Points& gradient, std::vector<ContactBlock>& blocks) {
            both->first.add_derivatives(x, gradient, blocks);
            both->second.add_derivatives(x, gradient, blocks);
          }};
}

}  // namespace selvedge
