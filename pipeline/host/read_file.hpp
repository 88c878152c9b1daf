#pragma once

#include <filesystem>
#include <string>

namespace selvedge {

// The whole content of a file. `noun` is what it should be, in the errors: "mesh", "BVH". Throws Error where it is a
// folder or cannot be opened.
std::string read_file(const std::filesystem::path&, const std::string& noun);

// The same of a file that is text, at least at its begin: without the byte order mark of UTF-8 that some editors put
// there. Throws Error for one of UTF-16 or UTF-32.
std::string read_text_file(const std::filesystem::path&, const std::string& noun);

}  // namespace selvedge
