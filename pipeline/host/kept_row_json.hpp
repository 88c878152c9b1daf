#pragma once

#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "pipeline/host/numbers_json.hpp"

namespace selvedge {

// The text of a kept row (kept_rows.hpp): its fields behind its key. What is no UTF-8 in them is replaced.
inline std::string kept_row_json(const Json& fields, const std::string& key) {
  Json json = {{"key", key}};
  json.update(fields);
  return json_text(json);
}

// What read(json, row) makes of a text; nothing where it is no JSON object, or a field is missing or of another type,
// as in a file of another version.
template <class Row, class Read>
std::optional<Row> read_row(const std::string& text, const Read& read) {
  const Json json = parse_json_or_discard(text);
  if (json.is_discarded() || !json.is_object()) return {};
  try {
    Row row;
    read(json, row);
    return row;
  } catch (const Json::exception&) {
    return {};
  }
}

// The same of a kept row; nothing where the key is another.
template <class Row, class Read>
std::optional<Row> read_kept_row(const std::string& text, const std::string& key, const Read& read) {
  const auto with_key = [&](const Json& json, std::optional<Row>& row) {
    if (json.value("key", "") == key) read(json, row.emplace());
  };
  return read_row<std::optional<Row>>(text, with_key).value_or(std::nullopt);
}

// A list of fields binds a row to its JSON: fields(row, visit) calls visit(name, row.member) for each. Values that are
// computed of the row are written and not read back. A number that is not finite is null, and is read as unknown (NaN).
template <class Row, class Fields>
Json row_to_json(const Row& row, const Fields& fields) {
  Json json;
  fields(row, [&]<class Value>(const char* name, const Value& value) {
    if constexpr (std::is_same_v<Value, double>)
      json[name] = number_or_null(value);
    else
      json[name] = value;
  });
  return json;
}
template <class Row, class Fields>
void row_from_json(const Json& json, const Fields& fields, Row& row) {
  fields(row, [&]<class Value>(const char* name, Value&& value) {
    if constexpr (std::is_lvalue_reference_v<Value>) {
      const Json& field = json.at(name);
      if constexpr (std::is_same_v<Value, double&>)
        value = field.is_null() ? std::numeric_limits<double>::quiet_NaN() : field.get<double>();
      else
        field.get_to(value);
    }
  });
}

// The same for the text of a row (as read_row), and for a list of rows.
template <class Row, class Fields>
std::optional<Row> read_fields(const std::string& text, const Fields& fields) {
  return read_row<Row>(text, [&](const auto& json, Row& row) { row_from_json(json, fields, row); });
}
template <class Row, class Fields>
Json rows_to_json(const std::vector<Row>& rows, const Fields& fields) {
  return json_list(rows, [&](const Row& row) { return row_to_json(row, fields); });
}

}  // namespace selvedge
