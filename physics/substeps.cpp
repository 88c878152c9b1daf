#include "physics/substeps.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

constexpr double edges_a_substep = 2.5;  // how far a vertex may move, in mean edge lengths

}  // namespace

int substeps_for(const State& from, const Drive& drive, double dt, double edge_length, int max_substeps) {
  double speed = drive.acceleration.norm() * dt;
  if (from.v.rows() > 0) speed += from.v.rowwise().norm().maxCoeff();
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    speed = std::max(speed, (drive.obstacles[k] - from.obstacles[k]).rowwise().norm().maxCoeff() / dt);
  const double wanted = edge_length > 0 ? std::ceil(speed * dt / (edges_a_substep * edge_length)) : 1;
  return static_cast<int>(std::clamp<double>(wanted, 2, max_substeps));
}

Points pinned_rows(const Scene& scene, const Points& nodes) {
  Points pins(scene.pins.size(), 3);
  for (std::size_t k = 0; k < scene.pins.size(); ++k) pins.row(static_cast<Eigen::Index>(k)) = nodes.row(scene.pins[k]);
  return pins;
}

}  // namespace selvedge
