#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "pipeline/host/numbers_json.hpp"

namespace selvedge {

// The text of a kept row (kept_rows.hpp): its fields behind its key. What is no UTF-8 in them is replaced.
inline std::string kept_row_json(const nlohmann::ordered_json& fields, const std::string& key) {
  nlohmann::ordered_json json = {{"key", key}};
  json.update(fields);
  return json_text(json);
}

// What read(json, row) makes of a kept row's text; nothing where the key is another, or a field is missing or of
// another type, as in a file of another version.
template <class Row, class Read>
std::optional<Row> read_kept_row(const std::string& text, const std::string& key, const Read& read) {
  const nlohmann::ordered_json json = nlohmann::ordered_json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("key", "") != key) return {};
  try {
    Row row;
    read(json, row);
    return row;
  } catch (const nlohmann::ordered_json::exception&) {
    return {};
  }
}

// A list of fields binds a row to its JSON: fields(row, visit) calls visit(name, row.member) for each. Values that are
// computed of the row are written and not read back.
template <class Row, class Fields>
nlohmann::ordered_json row_to_json(const Row& row, const Fields& fields) {
  nlohmann::ordered_json json;
  fields(row, [&](const char* name, const auto& value) { json[name] = value; });
  return json;
}
template <class Row, class Fields>
void row_from_json(const nlohmann::ordered_json& json, const Fields& fields, Row& row) {
  fields(row, [&]<class Value>(const char* name, Value&& value) {
    if constexpr (std::is_lvalue_reference_v<Value>) json.at(name).get_to(value);
  });
}

}  // namespace selvedge
