#include "pipeline/config/config.hpp"

#include <algorithm>
#include <cassert>
#include <cstdlib>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::string kind_text(const Key& key, const std::string& page) {
  const std::string name(names_of(key.kind).in_tables);
  if (key.kind == Kind::section || key.kind == Kind::sections)
    return name + "[" + key.section->name + "](" + page + "#" + key.section->name + ")";
  if (key.choices.empty()) return name;
  if (key.kind == Kind::number || key.kind == Kind::integer) return name + " or " + joined(key.choices);
  return key.kind == Kind::text ? joined(key.choices) : name;
}

}  // namespace

const KindNames& names_of(Kind kind) {
  static constexpr KindNames all[] = {
      {Kind::number, "number", "a number"},
      {Kind::integer, "integer", "an integer"},
      {Kind::boolean, "true or false", "true or false"},
      {Kind::text, "text", "text"},
      {Kind::path, "path", "a path"},
      {Kind::vector, "[x, y, z]", "three numbers [x, y, z]", true},
      {Kind::pair, "number or [a, b]", "a number or two of them [a, b]", true},
      {Kind::numbers, "number or list of numbers", "a number or a list of them", true},
      {Kind::integers, "integer or list of integers", "an integer or a list of them", true},
      {Kind::texts, "text or list of texts", "a text or a list of them", true},
      {Kind::section, "see ", "keys "},
      {Kind::sections, "list of ", "a list of sections with keys "}};
  static_assert(std::size(all) == 1 + static_cast<std::size_t>(Kind::sections));
  return *std::ranges::find(all, kind, &KindNames::kind);
}

bool Range::has(double value) const {
  return (low_in ? value >= low : value > low) && (high_in ? value <= high : value < high);
}

std::string Range::text() const {
  const Range none;
  const bool below = low != none.low, above = high != none.high;
  if (below && above)
    return fmt::format("{} {} to {}{}", low_in ? "from" : "above", low, high_in ? "" : "below ", high);
  if (below) return fmt::format("{} {}", low_in ? "at least" : "above", low);
  if (above) return fmt::format("{} {}", high_in ? "at most" : "below", high);
  return {};
}

const Config& Config::operator[](std::string_view name) const {
  assert(section);
  for (const Config& entry : entries)
    if (entry.key->name == name) return entry;
  assert(!"the key is not in the section's table");
  std::abort();
}

Config& Config::operator[](std::string_view name) {
  return const_cast<Config&>(static_cast<const Config&>(*this)[name]);
}

double Config::number() const {
  assert(!numbers.empty());
  return numbers[0];
}

int Config::integer() const { return static_cast<int>(number()); }

bool Config::flag() const { return number() != 0; }

const std::string& Config::text() const {
  assert(!words.empty());
  return words[0];
}

Vec3 Config::vector() const {
  assert(numbers.size() == 3);
  return {numbers[0], numbers[1], numbers[2]};
}

void Config::fail(const std::string& what, const std::string& cure) const {
  throw Error(path.empty() ? what : "`" + path + "` " + what, where, cure);
}

std::string joined(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& known) {
  std::string near;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : known)
    if (const std::size_t distance = edit_distance(word, candidate); distance < best_distance) {
      near = candidate;
      best_distance = distance;
    }
  return near.empty() ? "" : "; did you mean `" + near + "`?";
}

void refuse_unknown(const std::vector<std::string>& words, const std::vector<std::string>& known,
                    const std::string& what, const std::string& where, const std::string& listed) {
  for (const std::string& word : words)
    if (std::ranges::find(known, word) == known.end())
      throw Error("there is no " + what + " `" + word + "`", where,
                  listed + ": " + joined(known) + suggestion(word, known));
}

std::string section_chapter(const Section& section, const KeyPage& page) {
  std::string text = "### " + section.name + "\n\n";
  if (!section.about.empty()) text += section.about + "\n\n";
  if (!section.shorthand.empty()) text += "A plain value stands for `" + section.shorthand + "`.\n\n";
  text += "| key | value | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const Key& key : section.keys) {
    if (page.shows && !page.shows(section, key)) continue;
    text +=
        fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.name,
                    kind_text(key, page.page_of && key.section ? page.page_of(*key.section) : std::string()),
                    unit_symbol(key.unit), key.range.text(),
                    key.required ? "required" : (key.otherwise.empty() ? "" : "`" + key.otherwise + "`"), key.about);
  }
  return text + "\n";
}

}  // namespace selvedge
