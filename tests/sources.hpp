#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/source_root.hpp"

// Reads the repository's sources, for tests of its rules. Each rule is a function from texts to complaints "file:line:
// what", so that tests also try it on texts that break it.
namespace selvedge::sources {

namespace fs = std::filesystem;
using Complaints = std::vector<std::string>;
using Texts = std::map<std::string, std::string>;  // by path from the root

inline const std::vector<std::string> chain = {"collision", "physics", "learned", "pipeline"};
inline const fs::path root = source_root();

struct Include {
  int line;
  bool quoted;
  std::string header;
};

inline std::vector<Include> includes(const std::string& text) {
  static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*$)");
  std::vector<Include> found;
  std::istringstream lines(text);
  std::string line;
  std::smatch match;
  for (int number = 1; std::getline(lines, line); ++number)
    if (std::regex_match(line, match, directive)) found.push_back({number, match[1] == "\"", match[2]});
  return found;
}

inline std::string at(const std::string& file, int line) { return file + ":" + std::to_string(line) + ": "; }

inline std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The files below `folder` with one of the extensions.
inline Texts texts(const std::string& folder, const std::vector<std::string>& extensions) {
  Texts found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
    if (std::find(extensions.begin(), extensions.end(), entry.path().extension()) != extensions.end())
      found[entry.path().lexically_relative(root).generic_string()] = read(entry.path());
  return found;
}

inline Texts all_sources() {
  Texts found = texts("tests", {".cpp", ".hpp"});
  for (const std::string& module : chain) found.merge(texts(module, {".cpp", ".hpp"}));
  return found;
}

template <class Rule>
Complaints over_all_sources(const Rule& rule) {
  Complaints all;
  for (const auto& [file, text] : all_sources())
    for (const std::string& complaint : rule(file, text)) all.push_back(complaint);
  return all;
}

inline std::string listed(const Complaints& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) text += '\n' + complaint;
  return text;
}

// The path without its extension, which a header and its implementation share.
inline std::string stem_of(const std::string& file) { return file.substr(0, file.rfind('.')); }

// For each stem, the other stems of ours that its header and its implementation include.
inline std::map<std::string, std::set<std::string>> included_stems(const Texts& sources) {
  std::map<std::string, std::set<std::string>> found;
  for (const auto& [file, text] : sources) {
    std::set<std::string>& own = found[stem_of(file)];
    for (const Include& include : includes(text))
      if (include.quoted && stem_of(include.header) != stem_of(file)) own.insert(stem_of(include.header));
  }
  return found;
}

}  // namespace selvedge::sources
