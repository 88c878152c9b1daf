#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

// Fields that are bound to members of a struct. One row of a table names a field, says what it means, and says where it
// arrives: as a column of the trajectory, in the summary, in the page, in Python.
//
//   const BoundFields<StepCounts>& count_fields() {
//     using namespace report_table;
//     using C = StepCounts;
//     static const BoundFields<C> all{field("solves", &C::solves, "", "solves of a substep", {{"solves", Over::sum}})};
//     return all;
//   }
namespace selvedge {

// A field's value as people and programs read it. An enumerator is its word.
using FieldValue = std::variant<bool, std::int64_t, double, std::string, std::vector<int>>;

// What a column of the trajectory holds: nothing (there is no column), 0 or 1, a whole number of 32 or 64 bits, a
// number, the number of an enumerator, the number of a text, or the sum of a list.
enum class ColumnType { none, flag, whole, large, real, word, text, list };

// How the values of all frames become one of the summary. Code of their own (summary.cpp) makes the last four.
// bound_field.cpp has a text for each and field_total.cpp a value, in this order.
enum class Over {
  sum,
  largest,
  smallest,
  at_start,  // of frame 0
  at_end,    // of the last frame
  frames,    // in how many it is not 0
  first_frame,
  last_frame,
  by_word,
  milliseconds,              // a simulated frame
  milliseconds_where_there,  // left out where they are 0
  by_obstacle
};

struct InSummary {
  std::string key;
  Over over;
};

enum class Page { no, yes };  // whether the page that plays a run has the field

template <class Struct>
struct BoundField {
  std::string name;  // of the column, and in Python
  std::string unit;
  std::string about;
  ColumnType type = ColumnType::none;
  std::vector<std::string> words{};  // of an enumerator, by its number
  std::vector<InSummary> in_summary{};
  Page page = Page::no;
  std::function<FieldValue(const Struct&)> get{};
  std::function<void(const FieldValue&, Struct&)> set{};  // of a value that `get` may return; empty: it is read only
};

template <class Struct>
using BoundFields = std::vector<BoundField<Struct>>;

namespace report_table {

template <class T>
constexpr ColumnType type_of_column() {
  if constexpr (std::same_as<T, bool>) return ColumnType::flag;
  if constexpr (std::same_as<T, double>) return ColumnType::real;
  if constexpr (std::same_as<T, std::int64_t>) return ColumnType::large;
  if constexpr (std::same_as<T, std::string>) return ColumnType::text;
  if constexpr (std::same_as<T, std::vector<int>>) return ColumnType::list;
  return ColumnType::whole;
}

template <class Struct, class T>
BoundField<Struct> field(std::string name, T Struct::*member, std::string unit, std::string about,
                         std::vector<InSummary> in_summary = {}, Page page = Page::no) {
  using Value = std::conditional_t<std::same_as<T, int>, std::int64_t, T>;
  return {std::move(name),
          std::move(unit),
          std::move(about),
          type_of_column<T>(),
          {},
          std::move(in_summary),
          page,
          [member](const Struct& all) { return FieldValue(static_cast<Value>(all.*member)); },
          [member](const FieldValue& value, Struct& all) { all.*member = static_cast<T>(std::get<Value>(value)); }};
}

// An enumerator, by its word.
template <class Struct, class Enum>
requires std::is_enum_v<Enum> BoundField<Struct> field(std::string name, Enum Struct::*member,
                                                       const std::vector<std::string>& words, std::string about,
                                                       std::vector<InSummary> in_summary = {}, Page page = Page::no) {
  return {std::move(name),
          "",
          std::move(about),
          ColumnType::word,
          words,
          std::move(in_summary),
          page,
          [member, words](const Struct& all) { return FieldValue(words.at(static_cast<std::size_t>(all.*member))); },
          [member, words](const FieldValue& value, Struct& all) {
            for (std::size_t k = 0; k < words.size(); ++k)
              if (words[k] == std::get<std::string>(value)) all.*member = static_cast<Enum>(k);
          }};
}

// Fields of a member, as fields of the struct; `ending` is added to their names.
template <class Struct, class Part>
BoundFields<Struct> inside(Part Struct::*member, const BoundFields<Part>& parts, const std::string& ending = {}) {
  BoundFields<Struct> own;
  for (const BoundField<Part>& part : parts) {
    BoundField<Struct>& one = own.emplace_back(BoundField<Struct>{part.name + ending, part.unit, part.about, part.type,
                                                                  part.words, part.in_summary, part.page});
    one.get = [member, get = part.get](const Struct& all) { return get(all.*member); };
    if (part.set) one.set = [member, set = part.set](const FieldValue& value, Struct& all) { set(value, all.*member); };
  }
  return own;
}

template <class Struct>
BoundFields<Struct> operator+(BoundFields<Struct> a, const BoundFields<Struct>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace report_table

// A value as a number: 1 of what is true, an enumerator's number, the sum of a list; 0 of another text.
double number_of(const FieldValue&, const std::vector<std::string>& words);

// A table of fields as Markdown: column, unit, meaning, and what the summary has of it.
struct FieldLine {
  std::string name, unit, about;
  std::vector<InSummary> in_summary;
};
std::string fields_markdown(const std::vector<FieldLine>&);

template <class Struct>
std::vector<FieldLine> field_lines(const BoundFields<Struct>& fields) {
  std::vector<FieldLine> lines;
  for (const BoundField<Struct>& one : fields)
    if (one.type != ColumnType::none) lines.push_back({one.name, one.unit, one.about, one.in_summary});
  return lines;
}

}  // namespace selvedge
