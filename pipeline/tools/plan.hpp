#pragma once

#include <string>

#include "pipeline/scene/setup.hpp"

namespace selvedge {

// What this scene needs, what is left out, and why.
std::string plan_json(const Setup&);
std::string plan_text(const Setup&);

}  // namespace selvedge
