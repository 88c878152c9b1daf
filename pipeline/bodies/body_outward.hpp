#pragma once

#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/shapes/own_crossings.hpp"

namespace selvedge {

// Turns the closed shells of a body's surface outwards, judged in its zero pose (outward_mesh.hpp).
void turn_outward(const std::string& name, BodyModel&, std::vector<std::string>& warnings);

// Where the body's surface crosses itself in its zero pose, by its meshes.
OwnCrossings own_crossings(const BodyModel&, const Eigen::VectorXd& shape);

}  // namespace selvedge
