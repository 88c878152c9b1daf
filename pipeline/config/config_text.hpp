#pragma once

#include <string>

#include "pipeline/config/config.hpp"

namespace selvedge {

// A section that is given as YAML text, of which JSON is a part, and not in a file; `where` is for errors.
Config read_section(const std::string& yaml, const Section&, const std::string& where);

}  // namespace selvedge
