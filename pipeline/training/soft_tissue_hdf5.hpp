#pragma once

#include <filesystem>

#include "pipeline/training/training_world.hpp"

namespace selvedge {

// The displacements of soft tissue take long to compute. They are kept in files of a folder, one a body and clip, and
// reused by later runs. Files that cannot be read, or are of another body, are left alone; so are frames that are
// known.
void read_soft_tissue(const std::filesystem::path& folder, TrainingWorld&);
// Writes the clips of which the file knows fewer frames.
void write_soft_tissue(const std::filesystem::path& folder, const TrainingWorld&);

}  // namespace selvedge
