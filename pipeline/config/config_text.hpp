#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "pipeline/config/config.hpp"

namespace selvedge {

// A section that is given as YAML text, of which JSON is a part, and not in a file; `where` is for errors.
Config read_section(const std::string& yaml, const Section&, const std::string& where);

// The keys at the top of a YAML file, each with its value where that is a word, else with an empty text. `noun` is what
// the file should be. Throws Error, with the line, where it cannot be read or is no list of keys.
std::map<std::string, std::string> top_keys(const std::filesystem::path&, const std::string& noun);

}  // namespace selvedge
