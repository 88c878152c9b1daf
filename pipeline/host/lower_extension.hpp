#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace selvedge {

// The extension of a file's name in lower case: ".obj" of body.OBJ.
inline std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace selvedge
