#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

// Throws Error where the path is a folder, or a pipe, a socket or a device, whose reading might never end. A path with
// nothing there passes: who opens it says so. `noun` is what the file should be: "mesh", "BVH".
void require_file(const std::filesystem::path&, const std::string& noun);

}  // namespace selvedge
