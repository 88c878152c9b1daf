#pragma once

#include <filesystem>
#include <string>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The state in full precision, so that a resumed run goes on with the same bits. Written beside and renamed.
void write_checkpoint(const std::filesystem::path&, const State&, const std::string& config);

// Throws Error when there is none, when it was made under another configuration, and when it is damaged: arrays of
// other shapes or of different lengths, positions that are not finite.
State read_checkpoint(const std::filesystem::path&, const std::string& config);

// Throws Error unless the state, read from that file, has as many vertices, obstacles and triangles as the scene.
void check_fits(const std::filesystem::path&, const State&, const Scene&);

}  // namespace selvedge
