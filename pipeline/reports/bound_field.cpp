#include "pipeline/reports/bound_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace selvedge {
namespace {

// In the order of Over.
constexpr std::array over_texts{"sum",
                                "largest",
                                "smallest",
                                "of frame 0",
                                "of the last frame",
                                "number of frames",
                                "first frame, -1: none",
                                "last frame, -1: none",
                                "frames by word",
                                "mean [ms]",
                                "mean [ms], absent where it is 0",
                                "by obstacle"};

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
      keys += fmt::format("{}`{}`: {}", keys.empty() ? "" : "; ", one.key,
                          over_texts.at(static_cast<std::size_t>(one.over)));
    page += fmt::format("| `{}` | {} | {} | {} |\n", line.name, line.unit, line.about, keys);
  }
  return page;
}

}  // namespace selvedge
