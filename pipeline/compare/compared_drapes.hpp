#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

#include "pipeline/compare/repulsion_report.hpp"

namespace selvedge {

// Opens a finished training of drapes, measures all of its methods on the test drapes, and writes pages into `views`
// that play some of these side by side (figures 1, 4, 5 and 10 to 13): NAME.html with ways to handle collisions, and
// NAME_scales.html with fixed and predicted scales where distances are a network's. A run that cannot be opened is left
// out and says why. Nothing: `stop` said so.
std::optional<MeasuredDrapes> measured_drapes(const ComparedDrapes&, const std::filesystem::path& views,
                                              std::ostream* log, const std::function<bool()>& stop);

}  // namespace selvedge
