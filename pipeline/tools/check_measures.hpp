#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace selvedge {

// The measures of RunMeasures for a trajectory, and l2_mm and e3d against the same frames of another one with the same
// triangles. They are means over the common frames after the first. hood_losses are for HOOD's material, whatever the
// run's was, in gravity without wind. Throws Error for a file that is no trajectory or has other triangles.
std::map<std::string, double> measures_against(const std::filesystem::path& run,
                                               const std::filesystem::path& reference);

}  // namespace selvedge
