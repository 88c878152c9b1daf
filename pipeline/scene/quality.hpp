#pragma once

#include <string>
#include <vector>

#include "pipeline/config/config.hpp"

namespace selvedge {

// What run.quality may say, from the cheapest on.
std::vector<std::string> quality_names();

// Gives the keys of a scene file that its run.quality stands for their values, but for those that the file gives
// itself. Returns what it came to, for people: "preview: run.substeps 1, ...".
std::string set_quality(Config& scene);

}  // namespace selvedge
