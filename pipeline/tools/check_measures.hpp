#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace selvedge {

// What RunMeasures finds in the positions of a trajectory, and l2_mm and e3d against the same frames of another one of
// the same triangles, means over the frames that both have but the first. hood_losses are those of HOOD's material,
// whatever the run's was, in gravity without wind. Throws Error for a file that is no trajectory or has other
// triangles.
std::map<std::string, double> measures_against(const std::filesystem::path& run,
                                               const std::filesystem::path& reference);

}  // namespace selvedge
