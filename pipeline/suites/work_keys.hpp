#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace selvedge {

// What a YAML file has at its top.
struct WorkKeys {
  std::set<std::string> names;
  std::string cells;  // the value of the key `cells`; empty: there is none, or it is no word
  bool has(const std::string& name) const { return names.contains(name); }
};

// Throws Error where the file cannot be read, or is no list of keys.
WorkKeys work_keys(const std::filesystem::path& file);

}  // namespace selvedge
