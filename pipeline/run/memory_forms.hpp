#pragma once

#include <optional>
#include <string>

#include "physics/scene/memory.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Checks whether this memory may come from a stepper of this scene. If not, returns the block, what it is and what it
// should be. Blocks of this program's steppers are checked completely, those of others by what their rows belong to.
std::optional<std::string> misfit(const Memory&, const Scene&);

}  // namespace selvedge
