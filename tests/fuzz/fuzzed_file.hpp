#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "collision/geometry/error.hpp"

// A target gives its bytes to a reader. An Error is a right answer. Any other exception and any finding of the
// sanitizers ends the program.
namespace selvedge::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// A file in the memory of this process, for readers that need a path.
inline std::filesystem::path path_of(const std::string& extension) {
  std::error_code ignored;
  const std::filesystem::path memory = "/dev/shm";
  const auto folder = std::filesystem::exists(memory, ignored) ? memory : std::filesystem::temp_directory_path();
  return folder / ("selvedge_fuzz_" + std::to_string(::getpid()) + extension);
}

inline std::filesystem::path file_of(const std::string& extension, std::string_view bytes) {
  const std::filesystem::path path = path_of(extension);
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

template <class Read>
int read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    if (error.where().empty() || error.problem().empty()) std::terminate();  // an error must say where and what
  }
  return 0;
}

}  // namespace selvedge::fuzz
