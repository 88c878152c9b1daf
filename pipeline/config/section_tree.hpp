#pragma once

#include "pipeline/config/config.hpp"

namespace selvedge {

// A section and all sections that its keys lead to, each once, in the order of the keys.
std::vector<const Section*> sections_below(const Section&);

// All of them as chapters in Markdown.
std::string chapters_below(const Section&);

}  // namespace selvedge
