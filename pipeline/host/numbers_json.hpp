#pragma once

#include <cmath>
#include <optional>

#include "pipeline/host/json_text.hpp"

namespace selvedge {

// JSON has neither infinity nor NaN: null stands for a number that is not finite, or is not known.
inline Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
inline Json number_or_null(const std::optional<double>& value) {
  return value ? number_or_null(*value) : Json(nullptr);
}

// The list of what to_json makes of each row.
template <class Rows, class ToJson>
Json json_list(const Rows& rows, const ToJson& to_json) {
  Json list = Json::array();
  for (const auto& row : rows) list.push_back(to_json(row));
  return list;
}

}  // namespace selvedge
