#pragma once

#include <filesystem>
#include <string>

#include "physics/scene/stepper.hpp"

namespace selvedge {

// The state in full precision, so that a resumed run goes on with the same bits. Written beside and renamed.
void write_checkpoint(const std::filesystem::path&, const State&, const std::string& config);

// Throws Error when there is none, or when it was made under another configuration.
State read_checkpoint(const std::filesystem::path&, const std::string& config);

}  // namespace selvedge
