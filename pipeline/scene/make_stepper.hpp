#pragma once

#include <memory>

#include "pipeline/scene/setup.hpp"

namespace selvedge {

const std::vector<std::string>& known_steppers();

// The only switch over kinds of steppers. Keeps a reference to the setup's scene. Throws Error for an unknown kind.
std::unique_ptr<Stepper> make_stepper(const Setup&);

}  // namespace selvedge
