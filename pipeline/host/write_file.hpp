#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

// Written beside and renamed: a reader sees the old file or the new one, never half of it. Throws Error.
void write_file(const std::filesystem::path&, const std::string& content);

// Throws Error when the folder cannot be made.
void make_folder(const std::filesystem::path&);

}  // namespace selvedge
