#pragma once

#include <filesystem>

#include "pipeline/training/training_world.hpp"

namespace selvedge {

// The displacements of soft tissue take long to compute. They are kept in files of a folder, one a body and clip, and
// reused by later runs.

// The frames that the folder has of a body's clip; none where the folder is empty, or the file is not there or cannot
// be read.
std::map<int, TissueDisplacements> read_soft_tissue(const std::filesystem::path& folder, const TrainingWorld&,
                                                    const TrainingBody&, const TrainingClip&);
// Writes the clips of which the file knows fewer frames. Then takes away the files that were used longest ago, until
// the folder has no more than `most` bytes.
constexpr std::uintmax_t most_kept_tissue = std::uintmax_t{2} << 30;
void write_soft_tissue(const std::filesystem::path& folder, const TrainingWorld&,
                       std::uintmax_t most = most_kept_tissue);

}  // namespace selvedge
