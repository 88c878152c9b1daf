#pragma once

#include <catch2/catch.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace selvedge::fake {

// A file or a folder of ../shared/cases, which other people's files have broken; its README says what is right.
// Nothing, and a line that says so, where it is absent.
inline std::optional<std::filesystem::path> case_file(const std::string& name) {
  const std::filesystem::path file = std::filesystem::path(SELVEDGE_SOURCE_DIR) / ".." / "shared" / "cases" / name;
  if (std::filesystem::exists(file)) return file;
  WARN("skipped: " << file << " is not there");
  return std::nullopt;
}

}  // namespace selvedge::fake
