#pragma once

#include <functional>
#include <vector>

#include "collision/audit/audit.hpp"
#include "collision/audit/audit_memory.hpp"
#include "collision/audit/audit_motion.hpp"
#include "collision/contact/exemption.hpp"
#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The audit that every stepper ends a step with. Positions are rounded to float, as a file stores them: what is audited
// is what a reader will see. Cloth is held against itself where Scene::contact says so. Memories, where given, save
// time where little moves.

// Of positions [m]: crossing pairs of the cloth and with obstacles, and vertices inside closed ones.
Audit audit_positions(const Scene&, const Points& x, const std::vector<Points>& obstacles, AuditMemory* = nullptr);

// Of the state that a step made: sets `clean`, and in the report the audit, the intersecting pairs, those with
// obstacles where the drive wanted them, whether it is `penetrating`, and the seconds it took.
void audit_state(const Scene&, const Drive&, State&, AuditMemory&, StepReport&);

// Audits that a step has left to its caller (StepExtras::later), in the order in which the step would have made them.
// They keep copies of what they look at, and the stepper's memories: one thread at a time may make them, beside any
// step that leaves its audits too.
struct LaterAudits {
  std::vector<std::function<void(StepReport&)>> audits;
};

// Makes them: the report is as if the step had. False: the state is not clean, or its pairs are more than an audit may
// look at, and the step has to be taken again with its audits in it.
bool confirm(const LaterAudits&, StepReport&);

// Of the state without the triangles that are cut out of it.
Audit audit_uncut(const Scene&, const State&);
// What audit_state does with an audit, but for the drive: sets `clean`, and in the report the audit, the intersecting
// pairs and whether it is `penetrating`.
void take_audit(Audit, State&, StepReport&);

// Of the motion in which all nodes went straight from nodes0 to nodes1; pairs that contact leaves alone are not asked
// about.
MotionAudit audit_path(const ContactWorld&, const Exemption&, const Points& nodes0, const Points& nodes1, AuditMemory&);
// What passed through, and whether the audit gave up.
void add(const MotionAudit&, StepReport&);

}  // namespace selvedge
