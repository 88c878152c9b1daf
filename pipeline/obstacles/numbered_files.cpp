#include "pipeline/obstacles/numbered_files.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <set>

#include <fmt/format.h>

#include "pipeline/obstacles/setup_paths.hpp"

namespace selvedge {
namespace {

constexpr int most_named = 5;  // ranges of missing numbers in a warning

// A path, split at its number.
struct NumberPattern {
  std::string before, after;  // the digits of the number
  std::size_t width = 0;
  char fill = ' ';

  std::string with(int number) const {
    std::string digits = std::to_string(number);
    if (digits.size() < width) digits.insert(0, width - digits.size(), fill);
    return before + digits + after;
  }
};

NumberPattern read_pattern(const Config& pattern) {
  const std::string& text = pattern.text();
  const std::size_t begin = text.find('%');
  std::size_t end = begin == std::string::npos ? begin : begin + 1;
  NumberPattern read;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))
    read.width = std::min<std::size_t>(10 * read.width + static_cast<std::size_t>(text[end++] - '0'), 20);
  if (begin == std::string::npos || end >= text.size() || text[end] != 'd' || text.find('%', end) != std::string::npos)
    pattern.fail("is `" + text + "`", "write one %d or %04d where the number goes");
  read.fill = text[begin + 1] == '0' ? '0' : ' ';
  read.before = text.substr(0, begin);
  read.after = text.substr(end + 1);
  return read;
}

// The numbers of existing files, from the entries of the folder.
std::set<int> numbers_there(const Config& at, const NumberPattern& pattern, const std::filesystem::path& folder) {
  const std::size_t slash = pattern.before.rfind('/');
  const std::string above = slash == std::string::npos ? "." : pattern.before.substr(0, slash + 1),
                    start = slash == std::string::npos ? pattern.before : pattern.before.substr(slash + 1);
  std::set<int> numbers;
  std::error_code problem;
  for (const auto& entry : std::filesystem::directory_iterator(expanded_path(at, above, folder), problem)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start)) continue;
    const char *begin = name.data() + start.size(), *end = name.data() + name.size();
    while (begin != end && *begin == ' ') ++begin;
    int number = 0;
    if (std::from_chars(begin, end, number).ec != std::errc() || number < 0) continue;
    if (std::filesystem::exists(expanded_path(at, pattern.with(number), folder), problem)) numbers.insert(number);
  }
  return numbers;
}

// Which numbers are missing between the files, as "f3.obj", or "f7.obj to f9.obj, f12.obj".
std::string missing_text(const NumberPattern& pattern, const std::vector<NumberedFile>& files) {
  std::string text;
  int ranges = 0;
  for (std::size_t k = 1; k < files.size(); ++k) {
    const int from = files[k - 1].number + 1, to = files[k].number - 1;
    if (to < from) continue;
    if (++ranges > most_named) return text + ", ...";
    text += (text.empty() ? "" : ", ") + pattern.with(from) + (from == to ? "" : " to " + pattern.with(to));
  }
  return text;
}

}  // namespace

std::vector<NumberedFile> numbered_files(const Config& section, const std::filesystem::path& folder,
                                         std::vector<std::string>& warnings) {
  const Config &at = section["pattern"], &count = section["count"];
  const NumberPattern pattern = read_pattern(at);
  const std::set<int> there = numbers_there(at, pattern, folder);
  const int first = section["first"].integer();
  if (!there.empty() && !there.contains(first))
    section["first"].fail(fmt::format("is {}, and there is no {}", first, pattern.with(first)),
                          fmt::format("give first: {}", *there.begin()));
  const auto last = static_cast<double>(first) + (count.given ? count.number() - 1 : 0);
  std::vector<NumberedFile> files;
  for (auto number = there.lower_bound(first); number != there.end(); ++number)
    if (!count.given || *number <= last) files.push_back({*number, existing_path(at, pattern.with(*number), folder)});
  if (files.empty()) existing_path(at, pattern.with(first), folder);
  if (count.given && files.back().number < last)
    count.fail(fmt::format("asks for {} files, and {} is the last", count.number(), files.back().file.string()),
               fmt::format("give count: {}", std::int64_t{files.back().number} - first + 1));
  const std::int64_t wanted = std::int64_t{files.back().number} - first + 1;
  if (const std::string missing = missing_text(pattern, files); !missing.empty())
    warnings.push_back(
        fmt::format("{}: files of the sequence are missing, {} of {}: {}; in their place it moves "
                    "steadily from the one before to the one after",
                    section.where, wanted - std::ssize(files), wanted, missing));
  return files;
}

}  // namespace selvedge
