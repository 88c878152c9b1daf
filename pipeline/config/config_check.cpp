#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/config/config_yaml.hpp"

namespace selvedge {
namespace {

// A value on its way from YAML to Config, with what its messages need.
struct Check {
  const Origin& origin;
  Config& out;

  const Key& key() const { return *out.key; }
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what, const std::string& allowed) const {
    throw Error("`" + out.path + "` " + what, origin.of(node, out.path, out.where), "allowed: " + allowed);
  }
};

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return "`" + node.Scalar() + "`";
  if (node.IsSequence()) return "a list";
  return node.IsMap() ? "a section" : "nothing";
}

std::string expected(const Key& key) {
  std::string kind(names_of(key.kind).in_errors);
  if (key.kind == Kind::text && !key.choices.empty()) kind = joined(key.choices);
  if (key.kind == Kind::section || key.kind == Kind::sections) kind += joined(key_names(*key.section));
  if (key.unit != Unit::none)
    kind += " in " + unit_symbol(key.unit) + " or with a unit (" + unit_symbols(key.unit) + ")";
  if (const std::string range = key.range.text(); !range.empty()) kind += ", " + range;
  const bool exceptions = key.kind == Kind::number || key.kind == Kind::integer;
  if (exceptions && !key.choices.empty()) kind += ", or " + joined(key.choices);
  return kind;
}

void check_number(const Check& check, const YAML::Node& node) {
  const Key& key = check.key();
  if (!node.IsScalar()) check.fail(node, "is " + shown(node), expected(key));
  const Quantity q = read_quantity(node.Scalar(), key.unit);
  if (!q.problem.empty()) check.fail(node, "is " + shown(node) + ", which " + q.problem, expected(key));
  if (!key.range.has(q.value)) check.fail(node, "is " + shown(node), expected(key));
  const bool whole = key.kind == Kind::integer || key.kind == Kind::integers;
  if (whole && q.value != std::floor(q.value))
    check.fail(node, "is " + shown(node) + ", which is not an integer", expected(key));
  if (whole && std::abs(q.value) > 2e9) check.fail(node, "is " + shown(node) + ", beyond 2e9", expected(key));
  check.out.numbers.push_back(q.value);
}

void check_word(const Check& check, const YAML::Node& node) {
  const Key& key = check.key();
  if (!node.IsScalar() || node.Scalar().empty()) check.fail(node, "is " + shown(node), expected(key));
  const bool known = key.choices.empty() || std::ranges::count(key.choices, node.Scalar()) > 0;
  if (!known) check.fail(node, "is " + shown(node), expected(key) + suggestion(node.Scalar(), key.choices));
  check.out.words.push_back(node.Scalar());
}

void check_boolean(const Check& check, const YAML::Node& node) {
  if (!node.IsScalar()) check.fail(node, "is " + shown(node), "true or false");
  const std::string& word = node.Scalar();
  const bool yes = word == "true" || word == "yes" || word == "on";
  if (!yes && word != "false" && word != "no" && word != "off") check.fail(node, "is " + shown(node), "true or false");
  check.out.numbers.push_back(yes ? 1 : 0);
}

void check_value(const Check& check, const YAML::Node& node) {
  const Key& key = check.key();
  const auto each = [&](const auto& function, std::size_t least, std::size_t most) {
    if (!node.IsSequence()) return function(check, node);
    if (node.size() < least || node.size() > most)
      check.fail(node, fmt::format("has {} items", node.size()), expected(key));
    for (const YAML::Node& item : node) function(check, item);
  };
  switch (key.kind) {
    case Kind::number:
    case Kind::integer:
      for (const std::string& choice : key.choices)
        if (node.IsScalar() && node.Scalar() == choice) return check_word(check, node);
      return check_number(check, node);
    case Kind::boolean:
      return check_boolean(check, node);
    case Kind::text:
    case Kind::path:
      return check_word(check, node);
    case Kind::vector:
      if (!node.IsSequence()) check.fail(node, "is " + shown(node), expected(key));
      return each(check_number, 3, 3);
    case Kind::pair:
      each(check_number, 2, 2);
      if (check.out.numbers.size() == 1) check.out.numbers.push_back(check.out.numbers[0]);
      return;
    case Kind::numbers:
    case Kind::integers:
      return each(check_number, 1, static_cast<std::size_t>(key.most));
    case Kind::texts:
      return each(check_word, 1, static_cast<std::size_t>(key.most));
    case Kind::section:
    case Kind::sections:
      break;
  }
}

void check_known_once(const YAML::Node& node, const Section& section, const std::string& path, const std::string& where,
                      const Origin& origin) {
  std::vector<std::string> seen;
  for (const auto& pair : node) {
    const std::string name = pair.first.IsScalar() ? pair.first.Scalar() : "?";
    const std::string full = path.empty() ? name : path + "." + name;
    const std::string here = origin.of(pair.first, full, where);
    if (!find_key(section, name) && !is_retired(section, name, pair.second, full, here))
      throw Error(
          "`" + full + "` is not a known key" + (section.name.empty() ? "" : " of section `" + section.name + "`"),
          here, "allowed: " + joined(key_names(section)) + suggestion(name, key_names(section)));
    for (const std::string& other : seen)
      if (other == name) throw Error("`" + full + "` is given twice", here, "keep one of them");
    seen.push_back(name);
  }
}

Config checked_entry(const YAML::Node& node, const Key& key, const Config& parent, const Origin& origin) {
  Config out;
  out.key = &key;
  out.path = parent.path.empty() ? key.name : parent.path + "." + key.name;
  out.where = parent.where;
  out.given = node.IsDefined() && !node.IsNull();
  if (!out.given && key.required) throw Error("`" + out.path + "` is missing", parent.where, "give " + expected(key));
  if (!out.given && key.otherwise.empty()) return out;
  const YAML::Node value = out.given ? node : YAML::Load(key.otherwise);
  if (out.given) out.where = origin.of(value, out.path, parent.where);
  const Check check{origin, out};
  if (key.kind == Kind::section) {
    const bool given = out.given;
    out = checked_section(value, *key.section, out.path, out.where, origin);
    out.key = &key;
    out.given = given;
  } else if (key.kind == Kind::sections) {
    if (!value.IsSequence()) check.fail(value, "is " + shown(value), expected(key));
    for (std::size_t i = 0; i < value.size(); ++i) {
      out.items.push_back(
          checked_section(value[i], *key.section, fmt::format("{}.{}", out.path, i), out.where, origin));
      out.items.back().key = &key;
    }
  } else {
    check_value(check, value);
  }
  return out;
}

// A value that stands for one key of the section: a scalar, or a list where that key takes one.
bool is_plain(const YAML::Node& node, const Section& section) {
  const Key* key = section.shorthand.empty() ? nullptr : find_key(section, section.shorthand);
  if (!key) return false;
  return node.IsScalar() || (names_of(key->kind).list && node.IsSequence());
}

}  // namespace

bool is_retired(const Section& section, const std::string& name, const YAML::Node& value, const std::string& path,
                const std::string& where) {
  const auto found = std::ranges::find(section.retired, name, &RetiredKey::name);
  if (found == section.retired.end()) return false;
  const Quantity given = value.IsScalar() ? read_quantity(value.Scalar(), Unit::none) : Quantity{};
  if (value.IsScalar() && given.problem.empty() && given.value == found->value) return true;
  throw Error("`" + path + "` is a constant now", where,
              fmt::format("leave it out: it is {} ({})", found->value, found->instead));
}

Config checked_section(const YAML::Node& node, const Section& section, const std::string& path,
                       const std::string& parent, const Origin& origin) {
  Config out;
  out.section = &section;
  out.path = path;
  out.where = origin.of(node, path, parent);
  out.given = true;
  YAML::Node map = node;
  if (is_plain(node, section)) {
    map.reset(YAML::Node(YAML::NodeType::Map));
    map[section.shorthand] = node;
  }
  if (!map.IsMap())
    throw Error("`" + path + "` is " + shown(node), out.where, "give keys " + joined(key_names(section)));
  check_known_once(map, section, path, out.where, origin);
  int chosen = 0;
  for (const std::string& name : section.exactly_one) chosen += map[name] && !map[name].IsNull();
  if (!section.exactly_one.empty() && chosen != 1)
    throw Error(fmt::format("`{}` has {} of the keys {}", path, chosen, joined(section.exactly_one)), out.where,
                "give exactly one of them");
  for (const Key& key : section.keys) {
    const YAML::Node& readable = map;  // operator[] of a const node adds nothing
    out.entries.push_back(checked_entry(readable[key.name], key, out, origin));
  }
  return out;
}

}  // namespace selvedge
