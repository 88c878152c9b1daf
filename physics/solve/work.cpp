#include "physics/solve/work.hpp"

#include <algorithm>

#include "collision/contact/proximity.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "physics/energies/external.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {
namespace {

void raise(Eigen::VectorXd& most, int node, double value) { most[node] = std::max(most[node], value); }

}  // namespace

Work& Work::operator+=(const Work& other) {
  pins += other.pins;
  obstacles += other.obstacles;
  wind += other.wind;
  response += other.response;
  return *this;
}

WorkBound::WorkBound(const Scene& scene, const Elastic& elastic)
    : scene_(scene),
      world_(make_contact_world(scene.surface, obstacle_surfaces(scene), features_of(scene).self_contact, &scene.rest)),
      search_(world_),
      elastic_(elastic),
      masses_(lumped_masses(scene)) {}

void WorkBound::unnamed_forces(const State& from, const State& to, const Drive& drive) {
  const double dt = to.time - from.time;
  Points after;
  elastic_derivatives(elastic_, from.x, scratch_, &elastic_before_, nullptr);
  elastic_derivatives(elastic_, to.x, scratch_, &after, nullptr);
  const Points wind = wind_forces(scene_, to.x, to.v, drive.wind);
  unnamed_.resize(from.x.rows());
  wind_work_ = Eigen::VectorXd::Zero(from.x.rows());
  for (const Cloth& cloth : scene_.cloths)
    for (int i = cloth.first_vertex; i < cloth.first_vertex + cloth.vertex_count; ++i) {
      const Material& material = cloth.material;
      const Vec3 before = row(elastic_before_, i);
      // A spring between cloths of different damping counts at each end with the damping of that end's cloth.
      const Vec3 inertia = masses_[i] * ((row(to.v, i) - row(from.v, i)) / dt - drive.acceleration +
                                         material.mass_damping * row(to.v, i)) +
                           material.stiffness_damping / dt * (row(after, i) - before) - row(wind, i);
      unnamed_[i] = std::max((inertia + before).norm(), (inertia + row(after, i)).norm());
      wind_work_[i] = wind.row(i).norm() * (row(to.x, i) - row(from.x, i)).norm();
    }
}

void WorkBound::bound_by_start(const State& from, const State& to, const Drive& drive) {
  const double dt = to.time - from.time;
  unnamed_forces(from, to, drive);
  const Eigen::VectorXd of_end = unnamed_, wind_of_end = wind_work_;
  State flight;
  flight.time = to.time;
  flight.x = from.x + dt * from.v;
  for (const int pin : scene_.pins) flight.x.row(pin) = to.x.row(pin);
  flight.v = (flight.x - from.x) / dt;
  unnamed_forces(from, flight, drive);
  const Points wind = wind_forces(scene_, from.x, from.v, drive.wind);
  held_ = Eigen::VectorXd::Zero(from.x.rows());
  for (int i = 0; i < from.x.rows(); ++i) {
    const double force = wind.row(i).norm(), blown = std::min(drive.wind.norm(), force * dt / masses_[i]);
    held_[i] = (row(elastic_before_, i) - masses_[i] * drive.acceleration - row(wind, i)).norm();
    wind_work_[i] = std::min(wind_of_end[i], force * dt * (from.v.row(i).norm() + blown));
  }
  const Eigen::VectorXd of_flight = unnamed_;
  unnamed_ = of_end;
  for (const int pin : scene_.pins) unnamed_[pin] = std::min(of_end[pin], of_flight[pin]);
}

Work WorkBound::operator()(const State& from, const State& to, const Drive& drive) {
  unnamed_forces(from, to, drive);
  held_.resize(0);
  PathPairs near;
  return sum(from, to, near);
}

Work WorkBound::of_world(const State& from, const State& to, const Drive& drive, PathPairs* listed) {
  bound_by_start(from, to, drive);
  PathPairs own;
  return sum(from, to, listed ? *listed : own);
}

double WorkBound::carrying_force(const State& from, double dt, int vertex, const Vec3& way) const {
  if (held_.size() == 0) return unnamed_[vertex];
  const double brought = masses_[vertex] * (way / dt - row(from.v, vertex)).norm() / dt;
  return std::min(unnamed_[vertex], held_[vertex] + brought);
}

Eigen::VectorXd WorkBound::carried_work(const State& from, double dt, const Points& nodes0, const Points& nodes1,
                                        PathPairs& near) {
  Eigen::VectorXd most = Eigen::VectorXd::Zero(from.x.rows());
  const auto for_works = [&](const NodePair& pair, const auto& take) {
    for (const int node : pair.nodes) {
      if (world_.is_cloth(node)) continue;
      const Vec3 way = row(nodes1, node) - row(nodes0, node);
      const double moved = way.norm();
      if (moved == 0) continue;
      for (const int vertex : pair.nodes)
        if (world_.is_cloth(vertex)) take(vertex, carrying_force(from, dt, vertex, way) * moved);
    }
  };
  const double reach = contact_reach * scene_.contact.thickness;
  update_pairs(search_, reach, nodes0, nodes1, near);  // a list made for the thickness reaches so far at its own ends
  const TouchTest touches(near, reach, nodes0, nodes1);
  for (std::size_t i = 0; i < near.pairs.size(); ++i) {
    bool more = false;
    for_works(near.pairs[i], [&](int vertex, double work) { more = more || work > most[vertex]; });
    if (more && touches(i)) for_works(near.pairs[i], [&](int vertex, double work) { raise(most, vertex, work); });
  }
  return most;
}

Work WorkBound::sum(const State& from, const State& to, PathPairs& near) {
  Work work;
  const Eigen::VectorXd distance = (to.x - from.x).rowwise().norm();
  for (int i = 0; i < distance.size(); ++i) work.wind += wind_work_[i];
  std::vector<char> pinned(static_cast<std::size_t>(distance.size()), 0);
  for (const int pin : scene_.pins) {
    work.pins += unnamed_[pin] * distance[pin];
    pinned[pin] = 1;
  }
  if (!world_.self && world_.obstacles.empty()) return work;

  const Points nodes0 = gather_nodes(from.x, from.obstacles), nodes1 = gather_nodes(to.x, to.obstacles);
  const double thickness = scene_.contact.thickness;
  update_pairs(search_, thickness, nodes0, nodes1, near);
  const Eigen::VectorXd carried = carried_work(from, to.time - from.time, nodes0, nodes1, near);
  Eigen::VectorXd pressed = Eigen::VectorXd::Zero(distance.size());
  for (const Proximity& p : find_proximities(world_, pairs_within(near, nodes0, thickness), nodes0, thickness))
    for (const int node : p.pair.nodes)
      if (world_.is_cloth(node)) raise(pressed, node, p.rest_gap - p.gap);
  if (!from.clean) {
    const Exemption tangled = find_exemption(world_, nodes0);
    for (int i = 0; i < distance.size(); ++i)
      if ((!tangled.self.empty() && tangled.self[i]) || (!tangled.body.empty() && tangled.body[i]))
        pressed[i] = std::max(pressed[i], distance[i]);
  }
  for (int i = 0; i < distance.size(); ++i) {
    if (pinned[i]) continue;
    work.obstacles += carried[i];
    work.response += unnamed_[i] * pressed[i];
  }
  return work;
}

}  // namespace selvedge
