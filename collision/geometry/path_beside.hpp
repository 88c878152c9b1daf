#pragma once

#include <filesystem>

namespace selvedge {

// A path in the same folder that nobody can foresee, for a file that is written there and then renamed. Whoever makes
// that file asks for a new one (O_EXCL), so that no link which waits in a shared folder is followed.
std::filesystem::path path_beside(const std::filesystem::path&);

}  // namespace selvedge
