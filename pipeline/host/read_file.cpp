#include "pipeline/host/read_file.hpp"

#include <fstream>
#include <sstream>
#include <string_view>

#include "collision/geometry/error.hpp"

namespace selvedge {

std::string read_file(const std::filesystem::path& path, const std::string& noun) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw Error("is a folder", path.string(), "name the " + noun + " file in it");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in) throw Error("cannot be opened", path.string(), "check the path");
  return text.str();
}

std::string read_text_file(const std::filesystem::path& path, const std::string& noun) {
  using namespace std::literals;
  std::string text = read_file(path, noun);
  for (const std::string_view mark : {"\xFF\xFE"sv, "\xFE\xFF"sv, "\0\0\xFE\xFF"sv})
    if (text.starts_with(mark))
      throw Error("is written in UTF-16 or UTF-32", path.string(), "save the " + noun + " file as UTF-8");
  if (text.starts_with("\xEF\xBB\xBF"sv)) text.erase(0, 3);
  return text;
}

}  // namespace selvedge
