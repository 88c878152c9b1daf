#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace selvedge {

// A file that is written in parts, beside its place, and takes its name when it is kept: a reader sees the old file or
// the new one, never half of it. What is not kept is removed.
class GrowingFile {
 public:
  explicit GrowingFile(const std::filesystem::path&);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  void write(std::string_view);
  void keep();  // Throws Error where any of it could not be written.

 private:
  std::filesystem::path path_, beside_;
  std::ofstream stream_;
  bool kept_ = false;
};

}  // namespace selvedge
