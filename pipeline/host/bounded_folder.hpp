#pragma once

#include <cstdint>
#include <filesystem>

namespace selvedge {

// Takes away the files that were used longest ago, by their time of last writing, until the folder has no more than
// `most` bytes. Files that cannot be removed stay.
void keep_within(const std::filesystem::path& folder, std::uintmax_t most);

// Marks a file as used now.
void mark_used(const std::filesystem::path& file);

}  // namespace selvedge
