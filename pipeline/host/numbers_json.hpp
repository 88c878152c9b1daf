#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace selvedge {

// JSON has neither infinity nor NaN: null stands for a number that is not finite, or is not known.
inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}
inline nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? number_or_null(*value) : nlohmann::ordered_json(nullptr);
}

// JSON as a command's output and a file have it. What is no UTF-8 is replaced.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// The list of what to_json makes of each row.
template <class Rows, class ToJson>
nlohmann::ordered_json json_list(const Rows& rows, const ToJson& to_json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& row : rows) list.push_back(to_json(row));
  return list;
}

}  // namespace selvedge
