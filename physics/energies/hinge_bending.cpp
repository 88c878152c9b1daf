#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/energies/hinge_lanes.hpp"

namespace selvedge {
namespace {

double rest_length(const RestTriangle& rest, int corner) {
  return (rest.col((corner + 1) % 3) - rest.col(corner)).norm();
}

double angle_at(const Hinge& hinge, const Points& x) {
  return dihedral_angle(row(x, hinge.nodes[0]), row(x, hinge.nodes[1]), row(x, hinge.nodes[2]), row(x, hinge.nodes[3]));
}

// The difference to the rest angle, in [-pi, pi].
double wrapped_difference(const Hinge& hinge, const Points& x) {
  const double difference = angle_at(hinge, x) - hinge.rest_angle;
  return std::abs(difference) <= std::numbers::pi ? difference : std::remainder(difference, 2 * std::numbers::pi);
}

// What 1/2 difference^2 is multiplied by [N m].
double weight_of(const Hinge& hinge, double squared_length) {
  return hinge.length == HingeLength::current ? hinge.weight * squared_length : hinge.weight;
}

}  // namespace

std::vector<Hinge> hinges(const Scene& scene) {
  const Surface& surface = scene.surface;
  std::vector<double> stiffness(surface.vertex_count, 0);
  std::vector<HingeLength> length_of(surface.vertex_count, HingeLength::rest);
  for (const Cloth& cloth : scene.cloths)
    if (cloth.material.bending_model == BendingModel::hinge && cloth.material.bending > 0) {
      std::fill_n(stiffness.begin() + cloth.first_vertex, cloth.vertex_count, cloth.material.bending);
      std::fill_n(length_of.begin() + cloth.first_vertex, cloth.vertex_count, cloth.material.hinge_length);
    }
  std::vector<Hinge> result;
  for (int e = 0; e < surface.edges.rows(); ++e) {
    const double k = stiffness[surface.edges(e, 0)];
    const auto [first, second] = surface.edge_triangles[e];
    if (!(k > 0) || second < 0) continue;
    const int i = surface.side_of(first, e), j = surface.side_of(second, e);
    const RestTriangle &rest0 = scene.rest_triangle[first], &rest1 = scene.rest_triangle[second];
    const double areas = std::abs(area(rest0)) + std::abs(area(rest1));
    const double length = 0.5 * (rest_length(rest0, i) + rest_length(rest1, j));
    if (!(areas > 1e-12 * length * length)) continue;
    Hinge hinge;
    hinge.nodes = {surface.triangles(first, i), surface.triangles(first, (i + 1) % 3),
                   surface.triangles(first, (i + 2) % 3), surface.triangles(second, (j + 2) % 3)};
    hinge.length = length_of[surface.edges(e, 0)];
    hinge.weight = k * (hinge.length == HingeLength::current ? 1 : length * length) / (4 * areas);
    if (!scene.rest_is_flat) hinge.rest_angle = angle_at(hinge, scene.rest);
    result.push_back(hinge);
  }
  return result;
}

double dihedral_angle(const Vec3& e0, const Vec3& e1, const Vec3& a, const Vec3& b) {
  const Vec3 edge = e1 - e0, n0 = edge.cross(a - e0), n1 = (b - e0).cross(edge);
  const double length = edge.norm();
  return length > 0 ? std::atan2(edge.dot(n0.cross(n1)) / length, n0.dot(n1)) : 0;
}

double hinge_energy(const Hinge& hinge, const Points& x) {
  const double difference = wrapped_difference(hinge, x);
  const double squared = (row(x, hinge.nodes[1]) - row(x, hinge.nodes[0])).squaredNorm();
  return 0.5 * weight_of(hinge, squared) * difference * difference;
}

double hinge_energy(std::span<const Hinge> hinges, const Points& x) {
  HingeLanes lanes;
  double sum = 0;
  for (; !hinges.empty(); hinges = hinges.subspan(lanes.count)) {
    hinge_energies(hinges, x, false, lanes);
    for (int l = 0; l < lanes.count; ++l) sum += lanes.energy[l];
  }
  return sum;
}

}  // namespace selvedge
