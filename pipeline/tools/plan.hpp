#pragma once

#include <string>

#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The features that this scene needs and those that are left out, with reasons.
std::string plan_json(const Setup&);
std::string plan_text(const Setup&);

}  // namespace selvedge
