#include "physics/substeps.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

constexpr double edges_a_substep = 2.5;  // how far a vertex may move, in mean edge lengths
constexpr double edges_past = 1;         // how far contact, linearised, may slide: more locks cloth pulled round a post

}  // namespace

int substeps_for(const State& from, const Drive& drive, double dt, double edge_length, int max_substeps,
                 double contact_speed) {
  double speed = drive.acceleration.norm() * dt;
  if (from.v.rows() > 0) speed += from.v.rowwise().norm().maxCoeff();
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    speed = std::max(speed, (drive.obstacles[k] - from.obstacles[k]).rowwise().norm().maxCoeff() / dt);
  const double edges =
      edge_length > 0 ? dt * std::max(speed / edges_a_substep, contact_speed / edges_past) / edge_length : 1;
  return static_cast<int>(std::clamp<double>(std::ceil(edges), 2, max_substeps));
}

double fastest_past(std::span<const NodePair> pairs, const State& from, const Drive& drive, double dt) {
  std::vector<Points> obstacles;
  for (std::size_t k = 0; k < from.obstacles.size(); ++k)
    obstacles.push_back((drive.obstacles[k] - from.obstacles[k]) / dt);
  const Points v = gather_nodes(from.v, obstacles);
  double fastest = 0;
  for (const NodePair& pair : pairs) {
    fastest = std::max(fastest, (v.row(pair.nodes[0]) - v.row(pair.nodes[3])).norm());
  }
  return fastest;
}

void arrive(const State& from, const Leg& leg, double dt, State& to) {
  to.time = from.time + dt;
  to.frame = from.frame + 1;
  to.x = leg.nodes.topRows(from.x.rows());
  to.v = leg.v;
}

Points pinned_rows(const Scene& scene, const Points& nodes) {
  Points pins(scene.pins.size(), 3);
  for (std::size_t k = 0; k < scene.pins.size(); ++k) pins.row(static_cast<Eigen::Index>(k)) = nodes.row(scene.pins[k]);
  return pins;
}

}  // namespace selvedge
