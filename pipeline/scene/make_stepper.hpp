#pragma once

#include <memory>

#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The only switch over kinds of steppers. Keeps a reference to the setup's scene. Throws Error for an unknown kind.
std::unique_ptr<Stepper> make_stepper(const Setup&);

}  // namespace selvedge
