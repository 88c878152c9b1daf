#include "pipeline/host/read_file.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>

#include "collision/geometry/error.hpp"
#include "collision/geometry/require_file.hpp"
#include "pipeline/host/bounds.hpp"

namespace selvedge {

std::string read_file(const std::filesystem::path& path, const std::string& noun) {
  require_file(path, noun);
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (!ignored) refuse_too_many(static_cast<double>(size), most_file_bytes, "bytes", path.string(), "split the file");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in) throw Error("cannot be opened", path.string(), "check the path");
  return text.str();
}

std::string read_headed_file(const std::filesystem::path& path, const std::string& noun) {
  using namespace std::literals;
  std::string text = read_file(path, noun);
  for (const std::string_view mark : {"\xFF\xFE"sv, "\xFE\xFF"sv, "\0\0\xFE\xFF"sv})
    if (text.starts_with(mark))
      throw Error("is written in UTF-16 or UTF-32", path.string(), "save the " + noun + " file as UTF-8");
  if (text.starts_with("\xEF\xBB\xBF"sv)) text.erase(0, 3);
  return text;
}

std::string read_text_file(const std::filesystem::path& path, const std::string& noun) {
  std::string text = read_headed_file(path, noun);
  for (std::size_t begin = text.find('\r'); begin != std::string::npos; begin = text.find('\r', begin)) {
    const std::size_t end = std::min(text.find_first_not_of('\r', begin), text.size());
    if (end == text.size() || text[end] != '\n')
      std::fill(text.begin() + static_cast<std::ptrdiff_t>(begin), text.begin() + static_cast<std::ptrdiff_t>(end),
                '\n');
    begin = end;
  }
  return text;
}

std::filesystem::path path_below(const std::filesystem::path& folder, const std::string& named,
                                 const std::string& where) {
  const std::filesystem::path given(named);
  std::error_code ignored;
  const std::filesystem::path home = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, ignored);
  const std::filesystem::path real = std::filesystem::weakly_canonical(home / given, ignored);
  const auto [end, unused] = std::mismatch(home.begin(), home.end(), real.begin(), real.end());
  if (given.empty() || given.is_absolute() || end != home.end() || real == home)
    throw Error("names the file `" + named + "`, which is not below the folder of the file that names it", where,
                "put it there, and name it by that path");
  if (std::filesystem::exists(real) && !std::filesystem::is_regular_file(real, ignored))
    throw Error("names `" + named + "`, which is no regular file", where, "name a file");
  return real;
}

}  // namespace selvedge
