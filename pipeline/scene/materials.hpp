#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {

// A `material` section: the named material or file, with the section's own values over it. Its values are written back
// into the section, so that the effective configuration says what was used. `folder` is the scene file's.
Material read_material(Config& section, const std::filesystem::path& folder);

// Names of the materials that a scene file in `folder` may give, in alphabetical order.
std::vector<std::string> material_names(const std::filesystem::path& folder);

}  // namespace selvedge
