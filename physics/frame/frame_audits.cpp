#include "physics/frame/frame_audits.hpp"

#include <algorithm>
#include <utility>

#include "collision/exact/penetration_depth.hpp"
#include "collision/geometry/pair_budget.hpp"
#include "collision/geometry/stopwatch.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "collision/untangle/world_sheets.hpp"
#include "physics/recovery/cut_out.hpp"
#include "physics/scene/features.hpp"
#include "physics/scene/part_of_scene.hpp"

namespace selvedge {
namespace {

constexpr std::size_t most_parts = 4;  // whose memories are kept

Points rounded_to_float(const Points& x) { return x.cast<float>().cast<double>(); }

AuditMemory& memory_of(FrameAudits& audits, const std::shared_ptr<const PartOfScene>& part) {
  if (!part) return audits.whole;
  const auto found = std::ranges::find(audits.parts, part, &FrameAudits::OfPart::part);
  if (found != audits.parts.end()) return found->memory;
  if (audits.parts.size() == most_parts) audits.parts.erase(audits.parts.begin());
  return audits.parts.emplace_back(part).memory;
}

void audit_substeps(FrameAudits& audits, bool starts_clean, const StepPath& path, StepReport& report) {
  const Scene& scene = path.part ? path.part->scene : audits.scene;
  const Features features = features_of(scene);
  if (!features.self_contact && !features.obstacles) return;
  const ContactWorld world =
      make_contact_world(scene.surface, obstacle_surfaces(scene), features.self_contact, &scene.rest);
  AuditMemory& memory = memory_of(audits, path.part);
  const Points* start = &path.start;
  for (const SubstepEnd& substep : path.substeps) {
    std::optional<Exemption> found;
    if (!substep.left_alone) {
      found = starts_clean ? Exemption{} : find_exemption(world, *start);
      report.collision.left_alone = found->tangled_vertices();
    }
    ++report.counts.audits;
    add(audit_path(world, found ? *found : *substep.left_alone, *start, substep.nodes, memory), report);
    start = &substep.nodes;
  }
}

// The audit of a state of the scene, or of a part of it. Adds to the report the pairs and the depth with obstacles
// where the drive wanted them.
Audit audit_state(const Scene& scene, const State& state, const Drive& drive, AuditMemory& memory, StepReport& report) {
  ++report.counts.audits;
  Audit found = audit_positions(scene, state.x, state.obstacles, &memory);
  CollisionReport& collision = report.collision;
  collision.pairs_wanted = found.intersecting_pairs();
  if (!state.pinched) return found;
  ++report.counts.audits;
  collision.pairs_wanted = audit_positions(scene, state.x, drive.obstacles).intersecting_pairs();
  for (std::size_t k = 0; k < drive.obstacles.size(); ++k)
    collision.depth_wanted =
        std::max(collision.depth_wanted, penetration_depth(scene.obstacles[k].surface, drive.obstacles[k], state.x));
  return found;
}

// The part of the scene that is not cut out. It is the part that was stepped, unless triangles have come back.
std::shared_ptr<const PartOfScene> uncut_part(const Scene& scene, const State& from, const State& to,
                                              const StepPath& path) {
  if (path.part && to.cut_out == from.cut_out) return path.part;
  return std::make_shared<const PartOfScene>(part_of_triangles(scene, all_but(scene, to.cut_out)));
}

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

bool judge_frame(FrameAudits& audits, const State& from, const Drive& drive, const State& to, StepReport& report) {
  const StepPath path = std::exchange(report.path, {});
  if (report.status != StepStatus::accepted) return false;
  const Timed timed(report.seconds.audit);
  try {
    audit_substeps(audits, from.clean, path, report);
    if (!report.audit && to.cut_out.empty()) {
      report.audit = audit_state(audits.scene, to, drive, audits.whole, report);
    } else if (!report.audit) {
      const auto part = uncut_part(audits.scene, from, to, path);
      report.audit =
          whole_audit(*part, audit_state(part->scene, state_of(*part, to), drive, memory_of(audits, part), report));
    }
  } catch (const TooManyPairs&) {
    reject(Reason::too_many_pairs, report);
    return false;
  }
  const int pairs = report.audit->intersecting_pairs();
  report.collision.pairs_after = pairs;
  report.doubts.penetrating = pairs > 0;
  return pairs == 0 && report.audit->inside_vertices == 0;
}

}  // namespace selvedge
