#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/config.hpp"

namespace selvedge {

// The folder `configs` of the program: share/selvedge/configs for an installed program, configs beside an installed
// Python extension, else that of the source.
std::filesystem::path config_folder();

// The folders in which files that a scene names are searched, in order: the scene file's, the one above it, the
// program's configs.
std::vector<std::filesystem::path> config_folders(const std::filesystem::path& folder);

// The path of `name` in the first of these folders that has it, or else in the last.
std::filesystem::path config_near(const std::filesystem::path& folder, const std::string& name);

// The folder of caches: selvedge in XDG_CACHE_HOME, else in the user's .cache. Empty if the environment has neither, or
// if other users may write there and could put files into it; nothing is cached then.
std::filesystem::path cache_folder();

// The folder to which paths in a scene file are relative: its `folder`, or that of the file. Throws Error if it does
// not exist.
std::filesystem::path files_folder(const Config& scene, const std::filesystem::path& file);

// `text` with ${NAME} replaced by the environment's value (SELVEDGE_DATA has the default ../shared/data beside the
// source), relative to `folder`. Throws Error at `at` for an unknown variable.
std::filesystem::path expanded_path(const Config& at, const std::string& text, const std::filesystem::path& folder);

// The path that a value names; throws Error at the value where no such file exists.
std::filesystem::path existing_path(const Config& value, const std::filesystem::path& folder);
std::filesystem::path existing_path(const Config& at, const std::string& text, const std::filesystem::path& folder);

}  // namespace selvedge
