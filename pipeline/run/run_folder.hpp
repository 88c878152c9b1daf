#pragma once

#include <filesystem>

namespace selvedge {

// Removes the results of an earlier run from a folder, so that they are not taken for those of a run that fails.
void remove_results(const std::filesystem::path& folder);

// Removes only those results that a resumed run makes anew.
void remove_made_of_frames(const std::filesystem::path& folder);

}  // namespace selvedge
