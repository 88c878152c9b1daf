#pragma once

#include <string>

namespace selvedge {

// Versions, packages in this build, BLAS and threads.
std::string info_json();
std::string info_text();

}  // namespace selvedge
