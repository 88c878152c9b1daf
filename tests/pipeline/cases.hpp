#pragma once

#include <catch2/catch.hpp>

#include <filesystem>
#include <optional>
#include <string>

#include "tests/source_root.hpp"

namespace selvedge::fake {

// A file or a folder of ../shared/cases, with problems found by other people; its README has the right results.
// Nothing, with a line of warning, if it is absent.
inline std::optional<std::filesystem::path> case_file(const std::string& name) {
  const std::filesystem::path file = source_root() / ".." / "shared" / "cases" / name;
  if (std::filesystem::exists(file)) return file;
  WARN("skipped: " << file << " is not there");
  return std::nullopt;
}

}  // namespace selvedge::fake
