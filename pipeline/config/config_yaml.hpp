#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "pipeline/config/config.hpp"

namespace selvedge {

// A value of the command line, put into the file's tree: `where` it was given.
struct Override {
  std::string path, where;
};

// Where a node of a file was written, for messages.
struct Origin {
  std::string file;
  std::vector<Override> overrides;
  std::string of(const YAML::Node&, const std::string& path, const std::string& parent) const;
};

// Checks a tree against the table of its section.
Config checked_section(const YAML::Node&, const Section&, const std::string& path, const std::string& parent,
                       const Origin&);

std::vector<std::string> key_names(const Section&);
const Key* find_key(const Section&, std::string_view name);
// Whether the section had this key once and the value is the one that holds now. Throws Error for another value.
bool is_retired(const Section&, const std::string& name, const YAML::Node& value, const std::string& path,
                const std::string& where);

}  // namespace selvedge
