#pragma once

#include <utility>

#include <fmt/format.h>

#include "pipeline/config/config.hpp"

// What the tables of the scene file are written with, and the sections that several of them use.
namespace selvedge::table {

inline constexpr Range any{};
inline constexpr Range positive{.low = 0, .low_in = false};
inline constexpr Range not_negative{.low = 0};
inline constexpr Range at_least_one{.low = 1};

template <class T>
std::string show(const T& value) {
  return fmt::format("{}", value);
}

inline Key of_kind(Kind kind, std::string name, std::string otherwise, std::string about, Unit unit = Unit::none,
                   Range range = {}) {
  return {.name = std::move(name),
          .kind = kind,
          .about = std::move(about),
          .unit = unit,
          .range = range,
          .otherwise = std::move(otherwise)};
}
inline Key with_words(Key key, std::vector<std::string> choices) {
  key.choices = std::move(choices);
  return key;
}
inline Key number(std::string name, Unit unit, Range range, std::string otherwise, std::string about) {
  return of_kind(Kind::number, std::move(name), std::move(otherwise), std::move(about), unit, range);
}
inline Key integer(std::string name, Range range, std::string otherwise, std::string about) {
  return of_kind(Kind::integer, std::move(name), std::move(otherwise), std::move(about), Unit::none, range);
}
inline Key flag(std::string name, bool otherwise, std::string about) {
  return of_kind(Kind::boolean, std::move(name), show(otherwise), std::move(about));
}
inline Key named(std::string name, std::string otherwise, std::string about) {
  return of_kind(Kind::text, std::move(name), std::move(otherwise), std::move(about));
}
inline Key text(std::string name, std::string about) { return named(std::move(name), {}, std::move(about)); }
inline Key word(std::string name, std::vector<std::string> choices, std::string otherwise, std::string about) {
  return with_words(named(std::move(name), std::move(otherwise), std::move(about)), std::move(choices));
}
inline Key path(std::string name, std::string about) {
  return of_kind(Kind::path, std::move(name), {}, std::move(about));
}
inline Key vector(std::string name, Unit unit, std::string otherwise, std::string about) {
  return of_kind(Kind::vector, std::move(name), std::move(otherwise), std::move(about), unit);
}
inline Key pair(std::string name, Unit unit, std::string otherwise, std::string about, Range range = positive) {
  return of_kind(Kind::pair, std::move(name), std::move(otherwise), std::move(about), unit, range);
}
inline Key numbers(std::string name, Range range, std::string about) {
  return of_kind(Kind::numbers, std::move(name), {}, std::move(about), Unit::none, range);
}
inline Key integers(std::string name, Range range, int most, std::string about) {
  return {.name = std::move(name), .kind = Kind::integers, .about = std::move(about), .range = range, .most = most};
}
inline Key texts(std::string name, std::string about) {
  return of_kind(Kind::texts, std::move(name), {}, std::move(about));
}
inline Key of_sections(Kind kind, std::string name, const Section& table, std::string otherwise, std::string about) {
  Key key = of_kind(kind, std::move(name), std::move(otherwise), std::move(about));
  key.section = &table;
  return key;
}
inline Key section(const Section& table, std::string otherwise, std::string about) {
  return of_sections(Kind::section, table.name, table, std::move(otherwise), std::move(about));
}
inline Key sections(std::string name, const Section& table, std::string otherwise, std::string about) {
  return of_sections(Kind::sections, std::move(name), table, std::move(otherwise), std::move(about));
}
inline Key needed(Key key) {
  key.required = true;
  return key;
}

// Keys that have become constants of a header, each with its value.
inline std::vector<RetiredKey> constants(const std::string& header,
                                         const std::vector<std::pair<std::string, double>>& all) {
  std::vector<RetiredKey> retired;
  for (const auto& [name, value] : all) retired.push_back({name, value, header});
  return retired;
}

inline Key renamed(Key key, std::string name) {
  key.name = std::move(name);
  return key;
}

inline std::vector<Key> operator+(std::vector<Key> a, const std::vector<Key>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Key unit_key();  // of a file
Key weld_key();
Key weld_within_key();
std::vector<Key> placement_keys();
Key edge_key(const std::string& otherwise);
Key interpolation_key();
const Section& motion_section();
const Section& mesh_section();

}  // namespace selvedge::table
