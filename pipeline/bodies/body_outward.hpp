#pragma once

#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Turns the closed shells of a body's surface outwards, as it stands in its zero pose (outward_mesh.hpp).
void turn_outward(const std::string& name, BodyModel&, std::vector<std::string>& warnings);

}  // namespace selvedge
