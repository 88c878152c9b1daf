#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/config.hpp"

namespace selvedge {

// The folder `configs` of the program: share/selvedge/configs beside an installed program, configs beside an installed
// Python extension, else the source's.
std::filesystem::path config_folder();

// Where what a scene names is looked for, in this order: the scene file's folder, the one above it, the program's
// configs.
std::vector<std::filesystem::path> config_folders(const std::filesystem::path& folder);

// `name` in the first of these that has it, or else in the last.
std::filesystem::path config_near(const std::filesystem::path& folder, const std::string& name);

// Where what is made once is kept: selvedge in XDG_CACHE_HOME, else in the user's .cache. Empty where the environment
// has neither, and where another user may write there: nothing is kept then, for others could put files there.
std::filesystem::path cache_folder();

// Where the relative paths of a scene file begin: its `folder`, or its own. Throws Error where that is not there.
std::filesystem::path files_folder(const Config& scene, const std::filesystem::path& file);

// `text` with ${NAME} replaced by the environment's value (SELVEDGE_DATA has the default ../shared/data beside the
// source), relative to `folder`. Throws Error at `at` for an unknown variable.
std::filesystem::path expanded_path(const Config& at, const std::string& text, const std::filesystem::path& folder);

// The path that a value names; throws Error at the value where no such file exists.
std::filesystem::path existing_path(const Config& value, const std::filesystem::path& folder);
std::filesystem::path existing_path(const Config& at, const std::string& text, const std::filesystem::path& folder);

}  // namespace selvedge
