#include "pipeline/reports/bound_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace selvedge {
namespace {

const char* over_text(Over over) {
  switch (over) {
    case Over::sum:
      return "sum";
    case Over::largest:
      return "largest";
    case Over::smallest:
      return "smallest";
    case Over::at_start:
      return "of frame 0";
    case Over::at_end:
      return "of the last frame";
    case Over::frames:
      return "number of frames";
    case Over::first_frame:
      return "first frame, -1: none";
    case Over::last_frame:
      return "last frame, -1: none";
    case Over::by_word:
      return "frames by word";
    case Over::milliseconds:
      return "mean [ms]";
    case Over::milliseconds_where_there:
      return "mean [ms], absent where it is 0";
    case Over::by_obstacle:
      return "by obstacle";
  }
  return "";
}

}  // namespace

double number_of(const FieldValue& value, const std::vector<std::string>& words) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* list = std::get_if<std::vector<int>>(&value))
    return static_cast<double>(std::accumulate(list->begin(), list->end(), std::int64_t{0}));
  const auto found = std::ranges::find(words, std::get<std::string>(value));
  return found == words.end() ? 0 : static_cast<double>(found - words.begin());
}

std::string fields_markdown(const std::vector<FieldLine>& lines) {
  std::string page = "| column | unit | meaning | in `summary.json` |\n|---|---|---|---|\n";
  for (const FieldLine& line : lines) {
    std::string keys;
    for (const InSummary& one : line.in_summary)
      keys += fmt::format("{}`{}`: {}", keys.empty() ? "" : "; ", one.key, over_text(one.over));
    page += fmt::format("| `{}` | {} | {} | {} |\n", line.name, line.unit, line.about, keys);
  }
  return page;
}

}  // namespace selvedge
