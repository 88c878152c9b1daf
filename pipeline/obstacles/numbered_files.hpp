#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/config.hpp"

namespace selvedge {

struct NumberedFile {
  int number = 0;
  std::filesystem::path file;
};

// The files of a `pattern` with one %d or %0Nd, from the number `first` on, ascending: `count` numbers, or all that
// exist. Missing numbers before the last one are left out, with a warning. Throws Error if the first one or, with a
// count, the last one is missing.
std::vector<NumberedFile> numbered_files(const Config& section, const std::filesystem::path& folder,
                                         std::vector<std::string>& warnings);

}  // namespace selvedge
