#pragma once

#include <string>
#include <vector>

namespace selvedge {

// Which of the named parts of a file are taken: `only` those, or all, but for some.
struct NameChoice {
  std::vector<std::string> only, without;
  bool any() const { return !only.empty() || !without.empty(); }
  bool takes(const std::string& name) const;
  // Throws Error, naming `file` and the names that there are, for one that is chosen and is none of them.
  void check(const std::vector<std::string>& there_are, const std::string& file) const;
};

}  // namespace selvedge
