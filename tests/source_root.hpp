#pragma once

#include <filesystem>

namespace selvedge {

// The folder of the repository that these tests were built from. One source file alone holds it, so that a compile
// cache serves the others in any folder.
const std::filesystem::path& source_root();

}  // namespace selvedge
