#include "pipeline/host/json_csv.hpp"

#include <fmt/format.h>

#include "pipeline/host/json_text.hpp"

namespace selvedge {
namespace {

std::string cell(const Json& value) {
  if (value.is_array()) return fmt::format("\"{}\"", fmt::join(value.get<std::vector<std::string>>(), "; "));
  if (value.is_string()) return fmt::format("\"{}\"", value.get<std::string>());
  return json_line(value);
}

}  // namespace

std::string csv_of_json(const std::string& array) {
  std::vector<std::string> lines;
  for (const Json& row : parse_json(array)) {
    std::vector<std::string> titles, cells;
    for (const auto& [name, value] : row.items()) {
      titles.push_back(name);
      cells.push_back(cell(value));
    }
    if (lines.empty()) lines.push_back(fmt::format("{}", fmt::join(titles, ",")));
    lines.push_back(fmt::format("{}", fmt::join(cells, ",")));
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace selvedge
