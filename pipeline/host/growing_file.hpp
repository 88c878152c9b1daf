#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace selvedge {

// A file that is written in parts, beside its place, and takes its name when it is kept: a reader sees the old file or
// the new one, never half of it, and a link that has its name is replaced, not followed. What is not kept is removed.
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
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;  // null: it could not be made, or is closed
  int failed_ = 0;                                          // errno of what went wrong first
  bool kept_ = false;
};

}  // namespace selvedge
