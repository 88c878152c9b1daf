#pragma once

#include <string>

#include "pipeline/host/json_text.hpp"

namespace selvedge {

// The text of a file that other programs or people write. Throws Error with file and line where it is no JSON, has a
// number that is too large, or a key twice in an object.
Json json_of_file(const std::string& text, const std::string& file);

}  // namespace selvedge
