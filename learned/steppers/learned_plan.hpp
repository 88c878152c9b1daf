#pragma once

#include <vector>

#include "learned/network/architecture.hpp"
#include "physics/scene/features.hpp"

namespace selvedge {

// What of a network a scene uses and what it leaves out, and what of the scene the network leaves out.
std::vector<PlanLine> learned_plan_lines(const Scene&, const Architecture&, bool settle);

}  // namespace selvedge
