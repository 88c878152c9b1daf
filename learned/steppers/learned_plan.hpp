#pragma once

#include <vector>

#include "learned/steppers/learned_stepper.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {

// Lines for `selvedge plan`: which inputs of the network the scene uses or leaves out, and what of the scene the
// network ignores.
std::vector<PlanLine> learned_plan_lines(const Scene&, const Architecture&, const LearnedOptions&);

}  // namespace selvedge
