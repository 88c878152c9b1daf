#pragma once

#include <vector>

#include "learned/network/architecture.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {

// Lines for `selvedge plan`: which inputs of the network the scene uses or leaves out, and what of the scene the
// network ignores.
std::vector<PlanLine> learned_plan_lines(const Scene&, const Architecture&, bool settle);

}  // namespace selvedge
