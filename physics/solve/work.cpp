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

WorkBound::WorkBound(const Scene& scene)
    : scene_(scene),
      world_(make_contact_world(scene.surface, obstacle_surfaces(scene), features_of(scene).self_contact, &scene.rest)),
      search_(world_),
      elastic_(make_elastic(scene)),
      masses_(lumped_masses(scene)) {}

void WorkBound::unnamed_forces(const State& from, const State& to, const Drive& drive) {
  const double dt = to.time - from.time;
  Points before, after;
  elastic_derivatives(elastic_, from.x, scratch_, &before, nullptr);
  elastic_derivatives(elastic_, to.x, scratch_, &after, nullptr);
  wind_ = wind_forces(scene_, to.x, to.v, drive.wind);
  unnamed_.resize(from.x.rows());
  for (const Cloth& cloth : scene_.cloths)
    for (int i = cloth.first_vertex; i < cloth.first_vertex + cloth.vertex_count; ++i) {
      const Material& material = cloth.material;
      // A spring between cloths of different damping counts at each end with the damping of that end's cloth.
      const Vec3 inertia = masses_[i] * ((row(to.v, i) - row(from.v, i)) / dt - drive.acceleration +
                                         material.mass_damping * row(to.v, i)) +
                           material.stiffness_damping / dt * (row(after, i) - row(before, i)) - row(wind_, i);
      unnamed_[i] = std::max((inertia + row(before, i)).norm(), (inertia + row(after, i)).norm());
    }
}

Work WorkBound::operator()(const State& from, const State& to, const Drive& drive) {
  unnamed_forces(from, to, drive);
  Work work;
  const Eigen::VectorXd distance = (to.x - from.x).rowwise().norm();
  for (int i = 0; i < distance.size(); ++i) work.wind += wind_.row(i).norm() * distance[i];
  std::vector<char> held(static_cast<std::size_t>(distance.size()), 0);
  for (const int pin : scene_.pins) {
    work.pins += unnamed_[pin] * distance[pin];
    held[pin] = 1;
  }
  if (!world_.self && world_.obstacles.empty()) return work;

  const Points nodes0 = gather_nodes(from.x, from.obstacles), nodes1 = gather_nodes(to.x, to.obstacles);
  const double thickness = scene_.contact.thickness;
  PathPairs path;
  update_pairs(search_, thickness, nodes0, nodes1, path);
  Eigen::VectorXd carried = Eigen::VectorXd::Zero(distance.size()), pressed = carried;
  for (const NodePair& pair : path.pairs) {
    double moved = 0;
    for (const int node : pair.nodes)
      if (!world_.is_cloth(node)) moved = std::max(moved, (nodes1.row(node) - nodes0.row(node)).norm());
    if (moved == 0) continue;
    for (const int node : pair.nodes)
      if (world_.is_cloth(node)) raise(carried, node, moved);
  }
  for (const Proximity& p : find_proximities(world_, pairs_within(path, nodes0, thickness), nodes0, thickness))
    for (const int node : p.pair.nodes)
      if (world_.is_cloth(node)) raise(pressed, node, p.rest_gap - p.gap);
  if (!from.clean) {
    const Exemption tangled = find_exemption(world_, nodes0);
    for (int i = 0; i < distance.size(); ++i)
      if ((!tangled.self.empty() && tangled.self[i]) || (!tangled.body.empty() && tangled.body[i]))
        pressed[i] = std::max(pressed[i], distance[i]);
  }
  for (int i = 0; i < distance.size(); ++i) {
    if (held[i]) continue;
    work.obstacles += unnamed_[i] * carried[i];
    work.response += unnamed_[i] * pressed[i];
  }
  return work;
}

}  // namespace selvedge
