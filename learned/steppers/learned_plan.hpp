#pragma once

#include <vector>

#include "learned/steppers/learned_stepper.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {

// Lines for `selvedge plan`: inputs of the network that the scene uses or leaves out, and parts of the scene that the
// network ignores.
std::vector<PlanLine> learned_plan_lines(const Scene&, const Architecture&, const LearnedOptions&);

}  // namespace selvedge
