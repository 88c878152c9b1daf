#pragma once

#include <filesystem>

#include "pipeline/training/training_world.hpp"

namespace selvedge {

// How bodies give way takes long to find. What is known of it is kept in files of a folder, one a body and clip, and
// used by later runs. Files that cannot be read, or are of another body, are left alone; so are frames that are known.
void read_flesh(const std::filesystem::path& folder, TrainingWorld&);
// Writes the clips of which the file knows fewer frames.
void write_flesh(const std::filesystem::path& folder, const TrainingWorld&);

}  // namespace selvedge
