#include "pipeline/host/json_csv.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace selvedge {
namespace {

std::string cell(const nlohmann::ordered_json& value) {
  if (value.is_array()) return fmt::format("\"{}\"", fmt::join(value.get<std::vector<std::string>>(), "; "));
  if (value.is_string()) return fmt::format("\"{}\"", value.get<std::string>());
  return value.dump();
}

}  // namespace

std::string csv_of_json(const std::string& array) {
  std::vector<std::string> lines;
  for (const nlohmann::ordered_json& row : nlohmann::ordered_json::parse(array)) {
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
