#include "physics/recovery/drawn.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "collision/geometry/cell_grid.hpp"

namespace selvedge {
namespace {

void add_near(const ContactWorld& world, const std::vector<char>& switched_off, const Points& nodes, double reach,
              std::vector<char>& drawn) {
  std::vector<int> nodes_off;
  for (int node = world.cloth->vertex_count; node < world.node_count; ++node)
    if (switched_off[node]) nodes_off.push_back(node);
  const CellGrid grid(nodes(nodes_off, Eigen::all), reach);
  for (int v = 0; v < world.cloth->vertex_count; ++v) {
    if (!nodes.row(v).allFinite()) continue;
    grid.for_each_near(row(nodes, v), reach, [&](int i) {
      if ((nodes.row(nodes_off[static_cast<std::size_t>(i)]) - nodes.row(v)).norm() < reach) drawn[v] = 1;
    });
  }
}

}  // namespace

std::vector<char> drawn_vertices(const ContactWorld& world, const Exemption& exemption, const Points& targets,
                                 const Points& nodes, double reach) {
  if (targets.rows() == 0 || exemption.switched_off.empty()) return {};
  std::vector<char> drawn(static_cast<std::size_t>(targets.rows()), 0);
  add_near(world, exemption.switched_off, nodes, reach, drawn);
  for (std::size_t v = 0; v < drawn.size(); ++v)
    drawn[v] = drawn[v] && targets.row(static_cast<Eigen::Index>(v)).allFinite();
  return std::ranges::find(drawn, 1) == drawn.end() ? std::vector<char>() : drawn;
}

AddedTerm drawing_term(const std::vector<char>& drawn, const Eigen::VectorXd& masses, const Points& x0,
                       const Points& targets, double farthest, double h, double firmness) {
  struct Pull {
    int vertex;
    Vec3 target;
    double stiffness;  // [N/m]
  };
  const auto pulls = std::make_shared<std::vector<Pull>>();
  for (int v = 0; v < static_cast<int>(drawn.size()); ++v) {
    if (!drawn[v]) continue;
    const Vec3 whole = row(targets, v) - row(x0, v);
    pulls->push_back({v, row(x0, v) + std::min(1.0, farthest / whole.norm()) * whole, firmness * masses[v] / (h * h)});
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
