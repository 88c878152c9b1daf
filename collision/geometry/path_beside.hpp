#pragma once

#include <filesystem>

namespace selvedge {

// The cure where a file or a folder cannot be written, whatever keeps it from being so.
inline constexpr const char* write_cure =
    "check that the folder is there and may be written, and that its disk is not full";

// An unpredictable path in the same folder, for a file that is written there and then renamed. The caller must create
// that file with O_EXCL, so that it follows no link that somebody left in a shared folder.
std::filesystem::path path_beside(const std::filesystem::path&);

// The path for which path_beside has made this one, for messages; any other path unchanged.
std::filesystem::path path_in_place(const std::filesystem::path&);

}  // namespace selvedge
