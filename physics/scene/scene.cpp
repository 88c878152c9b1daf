#include "physics/scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {

RestTriangle flatten(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const double length = ab.norm();
  const double along = length > 0 ? ac.dot(ab) / length : 0;
  const double height = length > 0 ? ab.cross(ac).norm() / length : ac.norm();
  RestTriangle rest;
  rest << 0, length, along, 0, 0, height;
  return rest;
}

double area(const RestTriangle& rest) {
  const Vec2 u = rest.col(1) - rest.col(0), v = rest.col(2) - rest.col(0);
  return 0.5 * cross(u, v);
}

Eigen::VectorXd lumped_masses(const Scene& scene) {
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(scene.surface.vertex_count);
  for (const Cloth& cloth : scene.cloths)
    for (int t = cloth.first_triangle; t < cloth.first_triangle + cloth.triangle_count; ++t)
      for (int k = 0; k < 3; ++k)
        masses[scene.surface.triangles(t, k)] += cloth.material.density * std::abs(area(scene.rest_triangle[t])) / 3;
  return masses;
}

Eigen::VectorXd inverse_masses(const Scene& scene, int node_count) {
  const Eigen::VectorXd masses = lumped_masses(scene);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(node_count);
  for (int v = 0; v < masses.size(); ++v)
    if (masses[v] > 0) inverse[v] = 1 / masses[v];
  for (const int pin : scene.pins) inverse[pin] = 0;
  return inverse;
}

double smallest_altitude(const RestTriangle& t) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) longest = std::max(longest, (t.col(k) - t.col((k + 1) % 3)).norm());
  return longest > 0 ? 2 * std::abs(area(t)) / longest : 0;
}

double mean_edge_length(std::span<const RestTriangle> triangles) {
  double sum = 0;
  for (const RestTriangle& t : triangles)
    for (int k = 0; k < 3; ++k) sum += (t.col(k) - t.col((k + 1) % 3)).norm();
  return triangles.empty() ? 0 : sum / (3 * static_cast<double>(triangles.size()));
}

double mean_edge_length(const Scene& scene) { return mean_edge_length(scene.rest_triangle); }

std::vector<const Surface*> obstacle_surfaces(const Scene& scene) {
  std::vector<const Surface*> all;
  for (const Obstacle& obstacle : scene.obstacles) all.push_back(&obstacle.surface);
  return all;
}

}  // namespace selvedge
