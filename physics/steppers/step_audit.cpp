#include "physics/steppers/step_audit.hpp"

#include <algorithm>

#include "collision/exact/penetration_depth.hpp"
#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/world_sheets.hpp"
#include "physics/recovery/cut_out.hpp"
#include "physics/scene/part_of_scene.hpp"

namespace selvedge {
namespace {

Points rounded_to_float(const Points& x) { return x.cast<float>().cast<double>(); }

}  // namespace

Audit audit_positions(const Scene& scene, const Points& x, const std::vector<Points>& obstacles, AuditMemory* memory) {
  std::vector<Points> positions;
  for (const Points& obstacle : obstacles) positions.push_back(rounded_to_float(obstacle));
  std::vector<AuditBody> bodies;
  for (std::size_t k = 0; k < positions.size(); ++k) bodies.push_back({&scene.obstacles[k].surface, &positions[k]});
  return audit(scene.surface, rounded_to_float(x), bodies, scene.contact.self, memory);
}

Audit audit_uncut(const Scene& scene, const State& state) {
  if (state.cut_out.empty()) return audit_positions(scene, state.x, state.obstacles);
  const PartOfScene part = part_of_triangles(scene, all_but(scene, state.cut_out));
  return whole_audit(part, audit_positions(part.scene, state_of(part, state).x, state.obstacles));
}

void take_audit(Audit audit, State& state, StepReport& report) {
  const int pairs = audit.intersecting_pairs();
  report.collision.pairs_after = report.collision.pairs_wanted = pairs;
  state.clean = pairs == 0 && audit.inside_vertices == 0;
  report.doubts.penetrating = pairs > 0;
  report.audit = std::move(audit);
}

void audit_state(const Scene& scene, const Drive& drive, State& state, AuditMemory& memory, StepReport& report) {
  Stopwatch watch;
  ++report.counts.audits;
  take_audit(audit_positions(scene, state.x, state.obstacles, &memory), state, report);
  CollisionReport& collision = report.collision;
  if (state.pinched) {
    ++report.counts.audits;
    collision.pairs_wanted = audit_positions(scene, state.x, drive.obstacles).intersecting_pairs();
    for (std::size_t k = 0; k < drive.obstacles.size(); ++k)
      collision.depth_wanted =
          std::max(collision.depth_wanted, penetration_depth(scene.obstacles[k].surface, drive.obstacles[k], state.x));
  }
  report.seconds.audit += watch.lap();
}

bool confirm(const LaterAudits& later, StepReport& report) {
  try {
    for (const auto& audit : later.audits) audit(report);
  } catch (const TooManyPairs&) {
    return false;
  }
  return report.audit && report.audit->intersecting_pairs() == 0 && report.audit->inside_vertices == 0;
}

MotionAudit audit_path(const ContactWorld& world, const Exemption& exemption, const Points& nodes0,
                       const Points& nodes1, AuditMemory& memory) {
  const WorldSheets from(world, nodes0), to(world, nodes1);
  std::vector<MovingBody> bodies;
  for (std::size_t k = 1; k < from.views.size(); ++k)
    bodies.push_back({from.views[k].surface, &from.positions[k], &to.positions[k]});
  LeftOut left_out;
  if (exemption.any()) left_out = [&](const std::array<int, 4>& nodes) { return exemption.leaves_alone(world, nodes); };
  return audit_motion(*world.cloth, from.positions[0], to.positions[0], bodies, world.self, &memory, left_out);
}

void add(const MotionAudit& motion, StepReport& report) {
  report.collision.passed_through += motion.passed_through();
  report.out_of_proofs = report.out_of_proofs || motion.given_up > 0;
}

}  // namespace selvedge
