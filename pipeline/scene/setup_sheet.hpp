#pragma once

#include <filesystem>

#include "pipeline/config/config.hpp"
#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The mesh that a `cloth` section makes or reads, before it is placed; `folder` is the scene file's.
Mesh read_sheet(const Config& section, const std::filesystem::path& folder);

}  // namespace selvedge
