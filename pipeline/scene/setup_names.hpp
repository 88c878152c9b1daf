#pragma once

#include "pipeline/config/config.hpp"

namespace selvedge {

// Which of `all`, each of which has a name, a value names. Throws Error where it names none.
template <class Named>
int index_of(const Config& name, const std::vector<Named>& all) {
  std::vector<std::string> known;
  for (const Named& one : all) {
    if (one.name == name.text()) return static_cast<int>(known.size());
    known.push_back(one.name);
  }
  name.fail("names `" + name.text() + "`, which is not in the scene",
            known.empty() ? "there is none" : "known: " + joined(known) + suggestion(name.text(), known));
}

}  // namespace selvedge
