#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/points.hpp"
#include "pipeline/config/config_units.hpp"

namespace selvedge {

enum class Kind { number, integer, boolean, text, path, vector, pair, numbers, integers, texts, section, sections };

// How a kind is called in tables of keys and in errors. The names of a section's kinds go on with the section.
struct KindNames {
  Kind kind;
  std::string_view in_tables, in_errors;
  bool list = false;  // values of it are written as lists
};

const KindNames& names_of(Kind);

struct Range {
  double low = -1e300, high = 1e300;
  bool low_in = true, high_in = true;  // whether the end itself is allowed
  bool has(double) const;
  std::string text() const;  // "above 0", "0 to 1", empty for no limit
};

struct Section;

// One row of the table of allowed keys: drives reading, error messages, the effective configuration and the pages of
// keys.
struct Key {
  std::string name{};
  Kind kind = Kind::number;
  std::string about{};
  Unit unit = Unit::none;
  Range range{};
  std::string otherwise{};             // default as YAML text; empty: none
  std::vector<std::string> choices{};  // words allowed: the only values of a text, the exceptions of a number
  bool required = false;
  int most = 1 << 30;                // longest list of numbers or texts; one value may be given without brackets
  const Section* section = nullptr;  // of a section or of each in a list of sections
};

// A key that a section had once. A file may say it as long as it says what holds now.
struct RetiredKey {
  std::string name;
  double value = 0;     // that holds now, in SI units
  std::string instead;  // where that stands
};

struct Section {
  std::string name, about;
  std::vector<Key> keys = {};
  std::string shorthand = {};                 // the key that a plain value stands for
  std::vector<std::string> exactly_one = {};  // of these keys one must be given
  std::vector<RetiredKey> retired = {};
};

// A value of a configuration file, checked against its row, SI units. Sections hold one entry for every row of their
// table: given, default or absent.
struct Config {
  const Key* key = nullptr;          // null: the whole file
  const Section* section = nullptr;  // null: not a section
  std::string path;                  // cloths.0.material
  std::string where;                 // scene.yaml:12, or the override
  bool given = false;                // false: default or absent
  std::vector<double> numbers;
  std::vector<std::string> words;
  std::vector<Config> items;    // of a list of sections
  std::vector<Config> entries;  // of a section, one a row of its table

  bool present() const { return given || !numbers.empty() || !words.empty() || !entries.empty() || !items.empty(); }
  const Config& operator[](std::string_view name) const;  // name must be in the section's table
  Config& operator[](std::string_view name);
  double number() const;
  int integer() const;
  bool flag() const;
  const std::string& text() const;
  Vec3 vector() const;
  [[noreturn]] void fail(const std::string& what, const std::string& cure) const;  // throws Error at this value
};

// Reads a YAML file by its table. Overrides are key=value, keys dotted, list items by index or by their name.
// Throws Error with file, line, key, what is allowed and the nearest known key.
Config read_config(const std::filesystem::path&, const Section&, const std::vector<std::string>& overrides = {});

// Any text as a YAML value, in quotes, for files and overrides.
std::string quoted_yaml(const std::string& text);

// A section whose values come from elsewhere than a file, by keys that are not dotted; `where` is for errors.
struct GivenValue {
  std::string key, where;
  std::vector<std::string> words;  // several: a list
};
Config read_values(const Section&, const std::vector<GivenValue>&);

// The whole configuration, defaults filled in, as YAML that reads back to the same.
std::string to_yaml(const Config&);

// "; did you mean `x`?" with the known word of the smallest edit distance, for error messages; empty if none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& known);
std::string joined(const std::vector<std::string>& words);
// Throws Error for a word that is not known, with the known ones after `listed`. `what` is what a word names: "case".
void refuse_unknown(const std::vector<std::string>& words, const std::vector<std::string>& known,
                    const std::string& what, const std::string& where, const std::string& listed);

// The names of things that have one, in their order.
template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

// The keys of a section that a page shows, and the page on which each section has its chapter, empty: the same.
struct KeyPage {
  std::function<bool(const Section&, const Key&)> shows;
  std::function<std::string(const Section&)> page_of;
};
// A section as a chapter in Markdown: heading, what the section is about, what a plain value stands for, and the table
// of its keys; all of them stand on one page unless that is given.
std::string section_chapter(const Section&, const KeyPage& = {});

}  // namespace selvedge
