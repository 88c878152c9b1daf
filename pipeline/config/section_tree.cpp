#include "pipeline/config/section_tree.hpp"

#include <algorithm>

namespace selvedge {
namespace {

void collect(const Section& section, std::vector<const Section*>& found) {
  if (std::ranges::find(found, &section) != found.end()) return;
  found.push_back(&section);
  for (const Key& key : section.keys)
    if (key.section) collect(*key.section, found);
}

}  // namespace

std::vector<const Section*> sections_below(const Section& section) {
  std::vector<const Section*> found;
  collect(section, found);
  return found;
}

std::string chapters_below(const Section& section) {
  std::string text;
  for (const Section* one : sections_below(section)) text += section_chapter(*one);
  return text;
}

}  // namespace selvedge
