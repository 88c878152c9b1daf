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

// The audits of frames. Cloth is held against itself where Scene::contact says so. Memories, where given, save time
// where little moves.

// Of positions [m], rounded to float as a file stores them, so that a reader sees what is audited: crossing pairs of
// the cloth and with obstacles, and vertices inside closed ones.
Audit audit_positions(const Scene&, const Points& x, const std::vector<Points>& obstacles, AuditMemory* = nullptr);
// Of the state without the triangles that are cut out of it.
Audit audit_uncut(const Scene&, const State&);
// Of the motion in which all nodes went straight from nodes0 to nodes1; pairs that contact leaves alone are not asked
// about.
MotionAudit audit_path(const ContactWorld&, const Exemption&, const Points& nodes0, const Points& nodes1, AuditMemory&);
// What passed through, and whether the audit gave up.
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
  std::vector<OfPart> parts;  // of the last few parts of the scene that were stepped
};

// Judges an accepted step: audits its path substep by substep, then the state that it made, unless the report has that
// audit already. Returns whether the state is clean: no two triangles cross that share no vertex, and no vertex is
// inside a closed obstacle. What passed through on the way does not count. The report gets the audit, the number of
// pairs that passed through, the number of intersecting pairs, the same number with all obstacles where the drive
// wanted them, whether it is `penetrating`, and the seconds that this took; its path is gone after that. A step whose
// audit meets more pairs than it may look at (pair_budget.hpp) is rejected. Throws Stopped where a StopScope of the
// caller ends it.
[[nodiscard]] bool judge_frame(FrameAudits&, const State& from, const Drive&, const State& to, StepReport&);

}  // namespace selvedge
