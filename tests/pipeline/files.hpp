#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/pipeline/fake_run.hpp"
#include "tests/source_root.hpp"

namespace selvedge::fake {

inline std::filesystem::path write(const Folder& folder, const std::string& name, const std::string& content) {
  std::ofstream(folder.path / name, std::ios::binary) << content;
  return folder.path / name;
}

inline std::string whole(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// One text a line.
inline std::string lines(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + "\n";
  return all;
}

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// The largest distance between rows of the same number.
inline double farthest(const Points& a, const Points& b) { return (a - b).rowwise().norm().maxCoeff(); }

// The folder of the open data, which may be absent.
inline std::filesystem::path open_data() {
  const char* set = std::getenv("SELVEDGE_DATA");
  return set && *set ? std::filesystem::path(set) : source_root() / ".." / "shared" / "data";
}

}  // namespace selvedge::fake
