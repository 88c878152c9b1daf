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

// The files of a `pattern` with one %d or %0Nd from the number `first` on, ascending: `count` numbers, or all that
// there are. Numbers that are missing before the last one are left out, and a warning names them. Throws Error where
// the first one or, with a count, the last one is missing.
std::vector<NumberedFile> numbered_files(const Config& section, const std::filesystem::path& folder,
                                         std::vector<std::string>& warnings);

}  // namespace selvedge
