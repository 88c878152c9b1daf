#pragma once

#include <filesystem>
#include <iosfwd>

namespace selvedge {

// A run that is worth the disk gets a page, which is an extra: where none can be made, the log (or null) says why.
// Nothing is left of the folder of any other run.
void keep_or_remove(const std::filesystem::path& run_folder, bool keep, std::ostream* log);

}  // namespace selvedge
