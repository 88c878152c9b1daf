#include "physics/steppers/contact_stage.hpp"

#include <algorithm>
#include <utility>

#include "collision/contact/pins_give_way.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {
namespace {

// The work that the response may take in one step, over all its substeps and attempts. An ordinary frame with about
// 4,000 cloth vertices takes at most a twentieth of it (docs/results/contact.md).
ResponseWork most_response(int cloth_vertices) {
  const std::int64_t n = cloth_vertices;
  return {500'000 + 2'000 * n, 5'000'000 + 20'000 * n};
}

ResolveOptions resolve_options(const Scene& scene, ResolveOptions options) {
  const ContactSettings& contact = scene.contact;
  options.thickness = contact.thickness;
  options.separation = 0.1 * contact.thickness;
  options.friction = contact.friction;
  options.self_friction = contact.self_friction;
  options.rigid_zones = contact.rigid_zones;
  const ResponseWork most = most_response(scene.surface.vertex_count);
  options.budget = {std::min(options.budget.swept, most.swept), std::min(options.budget.projected, most.projected)};
  return options;
}

// What contact leaves alone, and pairs of bodies with the pins that they carry.
Exemption left_alone_by_pins(const ContactWorld& world, std::span<const int> pins, const Drive& drive,
                             Exemption left_alone) {
  const Points& targets = drive.skinned_targets;
  if (targets.rows() == 0) return left_alone;
  std::vector<char> carried(static_cast<std::size_t>(world.node_count), 0);
  for (const int pin : pins) carried[pin] = targets.row(pin).allFinite();
  for (std::size_t k = 0; k < drive.bodies.size(); ++k)
    if (drive.bodies[k].is_body())
      std::fill_n(carried.begin() + world.first_node[k], world.obstacles[k]->vertex_count, 1);
  left_alone.switched_off = either(std::move(carried), left_alone.switched_off);
  return left_alone;
}

}  // namespace

ContactStage::ContactStage(const Scene& scene, const ResolveOptions& limits)
    : world(make_contact_world(scene.surface, obstacle_surfaces(scene), features_of(scene).self_contact, &scene.rest)),
      search(world),
      options(resolve_options(scene, limits)),
      inverse_mass(inverse_masses(scene, world.node_count)) {}

void ContactStage::leave_alone(const Exemption* exemption) {
  const bool any = exemption && exemption->any();
  if (exempt || any) path = {};  // the list was made with other pairs left out
  exempt = any;
  search.leave_out(any ? exemption : nullptr);
}

int pins_give_way(ContactStage& stage, std::span<const int> pins, const ResolveOptions& options, const Drive& drive,
                  const Exemption& left_alone, const Points& x0, Points& x1, ResolveReport& report) {
  const Exemption by_pins = left_alone_by_pins(stage.world, pins, drive, left_alone);
  struct Restore {
    ~Restore() { search.leave_out(before); }
    PairSearch& search;
    const Exemption* before;
  } restore{stage.search, left_alone.any() ? &left_alone : nullptr};
  stage.search.leave_out(&by_pins);
  return pins_give_way(stage.search, stage.world, pins, options, x0, x1, report);
}

void add(const ResolveReport& resolved, StepReport& report) {
  report.collision.impulses += resolved.impulses;
  report.collision.zones += resolved.zones;
  report.collision.shortened += resolved.shortened;
  report.collision.held_vertices += resolved.held;
  report.counts.swept += resolved.work.swept;
  report.counts.projected += resolved.work.projected;
  report.out_of_response = report.out_of_response || resolved.out_of_work;
  report.seconds.broad_phase += resolved.broad_phase;
  report.seconds.ccd += resolved.ccd;
  report.seconds.response += resolved.response;
}

ResolveReport resolve_proposal(ContactStage& stage, const ResolveOptions& options, const State& from,
                               const Exemption* left_alone, Points& x, std::vector<Points>& obstacles) {
  const Points nodes0 = gather_nodes(from.x, from.obstacles);
  Points nodes1 = gather_nodes(x, obstacles);
  stage.leave_alone(left_alone);
  const ResolveReport report =
      resolve(stage.search, stage.world, stage.inverse_mass, options, nodes0, nodes1, stage.path);
  x = nodes1.topRows(x.rows());
  obstacles = split_rows(nodes1.bottomRows(nodes1.rows() - x.rows()), obstacles);
  return report;
}

}  // namespace selvedge
