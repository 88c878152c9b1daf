#pragma once

#include <optional>
#include <string>

#include "physics/scene/memory.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Why no stepper has left this memory in the scene, with the block, what it is and what it would be; nothing: one may
// have. Blocks of this program's steppers are known by all that they are, those of others by what their rows belong to.
std::optional<std::string> misfit(const Memory&, const Scene&);

}  // namespace selvedge
