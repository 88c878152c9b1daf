#pragma once

#include <memory>
#include <vector>

#include "collision/audit/audit.hpp"
#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_motion.hpp"
#include "collision/contact/exemption.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The audits of frames. Cloth is tested against itself if Scene::contact.self is set. A memory only saves time where
// little moves.

// Audits positions [m], rounded to float as a file stores them, so that a reader has what was audited: crossing pairs
// of the cloth with itself and with obstacles, and vertices inside closed obstacles.
Audit audit_positions(const Scene&, const Points& x, const std::vector<Points>& obstacles, AuditMemory* = nullptr);
// Audits a state without its triangles that are cut out.
Audit audit_uncut(const Scene&, const State&);
// Audits the motion of all nodes straight from nodes0 to nodes1, without pairs that contact leaves alone.
MotionAudit audit_path(const ContactWorld&, const Exemption&, const Points& nodes0, const Points& nodes1, AuditMemory&);
// Adds to the report what passed through, and whether the audit gave up.
void add(const MotionAudit&, StepReport&);

// What the audits of a scene's frames remember. A cache: one thread at a time may use it.
struct FrameAudits {
  explicit FrameAudits(const Scene& s) : scene(s) {}
  FrameAudits(const FrameAudits&) = delete;
  FrameAudits& operator=(const FrameAudits&) = delete;

  const Scene& scene;
  struct OfPart {
    std::shared_ptr<const PartOfScene> part;
    AuditMemory memory;
  };
  AuditMemory whole;
  std::vector<OfPart> parts;  // memories of the parts of the scene that were stepped last
};

// Judges an accepted step: audits its path substep by substep, then the new state, unless the report has that audit
// already. Returns whether the state is clean: no two triangles cross that share no vertex, and no vertex is inside a
// closed obstacle; pairs that passed through during the step do not count. Writes to the report the audit, the number
// of pairs that passed through, the number of intersecting pairs, also with obstacles where the drive wanted them, the
// doubt `penetrating`, and the seconds used. Removes the path from the report. A step whose audit meets more pairs than
// it may look at (pair_budget.hpp) is rejected. Throws Stopped if a StopScope of the caller ends it.
[[nodiscard]] bool judge_frame(FrameAudits&, const State& from, const Drive&, const State& to, StepReport&);

}  // namespace selvedge
