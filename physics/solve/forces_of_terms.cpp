#include "physics/solve/forces_of_terms.hpp"

#include <cmath>

namespace selvedge {
namespace {

Eigen::VectorXd lumped_rest_areas(const Scene& scene) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(scene.surface.vertex_count);
  for (std::size_t t = 0; t < scene.rest_triangle.size(); ++t)
    for (const int corner : scene.surface.triangles.row(static_cast<Eigen::Index>(t)))
      areas[corner] += std::abs(area(scene.rest_triangle[t])) / 3;
  return areas;
}

}  // namespace

ContactForces forces_of_terms(const Scene& scene, const SolvedContacts& solved, const Points& sticking) {
  const Points outward = vertex_normals(scene.surface, solved.x);
  Points front = Points::Zero(outward.rows(), 3), back = front;
  ContactForces forces;
  forces.friction = sticking;
  for (std::size_t k = 0; k < solved.terms.size(); ++k) {
    ContactTerm bounded = solved.terms[k];
    bounded.normal_force = solved.friction_loads[k];
    const Vec3 slip = contact_slip(bounded, solved.x0, solved.x);
    const Vec3 brake = -friction_force(bounded, slip, solved.slip_width).factor * slip;
    for (std::size_t i = 0; i < bounded.nodes.size(); ++i) {
      const int node = bounded.nodes[i];
      if (node < 0) continue;
      const Vec3 push = bounded.weights[i] * solved.terms[k].normal_force * bounded.normal;
      (push.dot(row(outward, node)) > 0 ? back : front).row(node) += push.transpose();
      forces.friction.row(node) += bounded.weights[i] * brake.transpose();
    }
  }
  forces.normal = front + back;
  const Eigen::VectorXd areas = lumped_rest_areas(scene);
  const Eigen::VectorXd pressed = front.rowwise().norm().cwiseMax(back.rowwise().norm());
  forces.pressure = (areas.array() > 0).select(pressed.array() / areas.array(), 0.0);
  return forces;
}

}  // namespace selvedge
