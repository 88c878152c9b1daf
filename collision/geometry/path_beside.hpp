#pragma once

#include <filesystem>

namespace selvedge {

// An unpredictable path in the same folder, for a file that is written there and then renamed. The caller must create
// that file with O_EXCL, so that it follows no link that somebody left in a shared folder.
std::filesystem::path path_beside(const std::filesystem::path&);

}  // namespace selvedge
