#include <algorithm>
#include <cmath>

#include "physics/bending.hpp"
#include "physics/curvature_stencil.hpp"

namespace selvedge {
namespace {

Vec3 laplacian_of(const CurvedVertex& vertex, const Points& x) {
  const Vec3 centre = row(x, vertex.nodes[0]);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i < vertex.nodes.size(); ++i) sum += vertex.laplacian[i] * (row(x, vertex.nodes[i]) - centre);
  return sum;
}

// Twice the vector area of the ring.
Vec3 ring_normal(const CurvedVertex& vertex, const Points& x) {
  const Vec3 centre = row(x, vertex.nodes[0]);
  Vec3 sum = Vec3::Zero(), previous = row(x, vertex.nodes.back()) - centre;
  for (std::size_t i = 1; i < vertex.nodes.size(); ++i) {
    const Vec3 next = row(x, vertex.nodes[i]) - centre;
    sum += previous.cross(next);
    previous = next;
  }
  return sum;
}

// Adds stiffness |weights . x|^2 / 2.
void add_square(const std::vector<int>& nodes, const std::vector<double>& weights, double stiffness,
                std::vector<Eigen::Triplet<double>>& entries) {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      entries.emplace_back(nodes[i], nodes[j], stiffness * (weights[i] * weights[j]));
}

}  // namespace

double bending_poisson(const Material& material) {
  const double sum = material.lame_lambda + 2 * material.lame_mu;
  return material.membrane == MembraneModel::baraff_witkin || !(sum > 0) ? 0 : material.lame_lambda / sum;
}

CurvatureBending curvature_bending(const Scene& scene) {
  // A rest curvature below this angle per vertex is rounding in the input and counts as flat.
  constexpr double flat_angle = 1e-5;
  CurvatureBending bending;
  std::vector<Eigen::Triplet<double>> entries;
  for (CurvatureStencil& stencil : curvature_stencils(scene)) {
    const Material& material = scene.cloths[stencil.cloth].material;
    const double nu = bending_poisson(material);
    const double stiffness = material.bending * stencil.trace_area / (stencil.cell * stencil.cell);
    if (!scene.rest_is_flat) {
      CurvedVertex vertex{stencil.nodes, stencil.laplacian, stiffness, 0};
      const Vec3 curvature = laplacian_of(vertex, scene.rest);
      if (curvature.norm() > flat_angle * std::sqrt(stencil.cell)) {
        vertex.rest = curvature.dot(ring_normal(vertex, scene.rest).normalized());
        bending.curved.push_back(std::move(vertex));
        continue;
      }
    }
    add_square(stencil.nodes, stencil.laplacian, stencil.deviator_elsewhere ? 0.5 * (1 + nu) * stiffness : stiffness,
               entries);
    if (stencil.a.empty()) continue;
    for (const std::vector<double>* weights : {&stencil.a, &stencil.b})
      add_square(stencil.nodes, *weights, 2 * (1 - nu) * material.bending * stencil.deviator_area, entries);
  }
  bending.flat.resize(scene.surface.vertex_count, scene.surface.vertex_count);
  bending.flat.setFromTriplets(entries.begin(), entries.end());
  return bending;
}

double curved_energy(const CurvedVertex& vertex, const Points& x) {
  const double difference = laplacian_of(vertex, x).dot(ring_normal(vertex, x).normalized()) - vertex.rest;
  return 0.5 * vertex.stiffness * difference * difference;
}

double curved_derivatives(const CurvedVertex& vertex, const Points& x, Eigen::VectorXd& gradient,
                          Eigen::MatrixXd* hessian) {
  const int count = static_cast<int>(vertex.nodes.size()), ring = count - 1;
  const Vec3 curvature = laplacian_of(vertex, x), area_vector = ring_normal(vertex, x);
  const double length = area_vector.norm(), inverse = length > 0 ? 1 / length : 0;
  const Vec3 normal = inverse * area_vector;
  const double difference = curvature.dot(normal) - vertex.rest;
  const Vec3 tangential = inverse * (curvature - curvature.dot(normal) * normal);
  // d((L x) . n) = n . L dx + tangential . dN. A ring vertex moves N by dx x (next - previous); the centre does not.
  gradient.resize(3 * count);
  gradient.head<3>() = vertex.laplacian[0] * normal;
  for (int i = 0; i < ring; ++i) {
    const Vec3 across = row(x, vertex.nodes[1 + (i + 1) % ring]) - row(x, vertex.nodes[1 + (i + ring - 1) % ring]);
    gradient.segment<3>(3 * i + 3) = vertex.laplacian[i + 1] * normal + across.cross(tangential);
  }
  if (hessian) *hessian = vertex.stiffness * gradient * gradient.transpose();
  gradient *= vertex.stiffness * difference;
  return 0.5 * vertex.stiffness * difference * difference;
}

}  // namespace selvedge
