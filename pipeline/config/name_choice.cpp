#include "pipeline/config/name_choice.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config.hpp"

namespace selvedge {

bool NameChoice::takes(const std::string& name) const {
  const bool wanted = only.empty() || std::ranges::count(only, name) > 0;
  return wanted && std::ranges::count(without, name) == 0;
}

void NameChoice::check(const std::vector<std::string>& there_are, const std::string& file) const {
  for (const auto* names : {&only, &without})
    for (const std::string& name : *names)
      if (std::ranges::count(there_are, name) == 0)
        throw Error("has no mesh `" + name + "`", file,
                    there_are.empty() ? "it names none" : "it has " + joined(there_are));
}

}  // namespace selvedge
