#pragma once

#include <filesystem>

#include "pipeline/training/training_world.hpp"

namespace selvedge {

// The displacements of soft tissue take long to compute. Files of a folder, one per body and clip, keep them for later
// runs.

// The frames of a body's clip in the folder. None if there is no folder, or no readable file.
std::map<int, TissueDisplacements> read_soft_tissue(const std::filesystem::path& folder, const TrainingWorld&,
                                                    const TrainingBody&, const TrainingClip&);
// Writes the clips of which the file has fewer frames. Then it removes the least recently used files until the folder
// has at most `most` bytes.
constexpr std::uintmax_t most_kept_tissue = std::uintmax_t{2} << 30;
void write_soft_tissue(const std::filesystem::path& folder, const TrainingWorld&,
                       std::uintmax_t most = most_kept_tissue);

}  // namespace selvedge
