#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "collision/geometry/path_beside.hpp"

namespace selvedge {

// Written beside and renamed: a reader sees the old file or the new one, never half of it. Throws Error.
void write_file(const std::filesystem::path&, const std::string& content);

// Throws Error, with that cure, when the folder cannot be made.
void make_folder(const std::filesystem::path&, const std::string& cure = write_cure);

// Removes a file if it is there. Throws Error when it cannot be removed.
void remove_file(const std::filesystem::path&);

// Gives a file another name, in place of what has it. Throws Error when it cannot be renamed.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

// Writes a file into a folder that is made for it and that the environment chooses. Throws Error that says how.
void write_cached(const std::filesystem::path& file, const std::function<void()>& write);

}  // namespace selvedge
