#pragma once

#include <string>
#include <vector>

#include "physics/scene/stepper.hpp"
#include "pipeline/reports/bound_field.hpp"

namespace selvedge {

// All that a step's report says but its path: the one list of its fields. Trajectory, summary, page, Python and
// docs/files.md are made from it. Whoever adds a member to one of these structs adds a row here; a test fails until it
// is there.
const BoundFields<PhaseTimes>& phase_fields();
const BoundFields<Doubts>& doubt_fields();
const BoundFields<StepCounts>& count_fields();
const BoundFields<CollisionReport>& collision_fields();
const BoundFields<StepReport>& report_fields();  // with those of its parts

// Names of the enumerators, in order.
const std::vector<std::string>& reason_names();
const std::vector<std::string>& verdict_names();

}  // namespace selvedge
