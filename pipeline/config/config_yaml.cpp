#include "pipeline/config/config_yaml.hpp"

#include <charconv>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/config/aliases_yaml.hpp"
#include "pipeline/config/config_text.hpp"
#include "pipeline/host/read_file.hpp"

namespace selvedge {
namespace {

YAML::Node loaded(const std::string& text, const std::string& where) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    for (std::size_t i = 1; i < documents.size(); ++i)
      if (!documents[i].IsNull())
        throw Error("holds more than one YAML document", where,
                    "keep one, and a file for each other: a line `---` begins another");
    return documents.empty() ? YAML::Node() : documents[0];
  } catch (const YAML::Exception& e) {
    throw Error("is not YAML: " + e.msg, e.mark.is_null() ? where : fmt::format("{}:{}", where, e.mark.line + 1),
                "look there and in the lines before it: brackets and quotes that are not closed, tabs, other indents");
  }
}

// The item of a list that a path names by index or by the item's `name`.
std::size_t item_index(const YAML::Node& list, const std::string& word, const std::string& path,
                       const std::string& where) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    names.push_back(std::to_string(i));
    if (!list[i].IsMap() || !list[i]["name"] || !list[i]["name"].IsScalar()) continue;
    if (list[i]["name"].Scalar() == word) return i;
    names.back() += " (" + list[i]["name"].Scalar() + ")";
  }
  std::size_t index = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), index);
  if (problem == std::errc() && end == word.data() + word.size() && index < list.size()) return index;
  throw Error("`" + path + "` has no item `" + word + "`", where,
              list.size() ? "items: " + joined(names) : "the list is empty or absent");
}

// Items that `words` names become their indices in it.
void assign(YAML::Node node, const Section& section, std::vector<std::string>& words, std::size_t depth,
            const YAML::Node& value, const std::string& where) {
  std::string path;
  for (std::size_t i = 0; i < depth; ++i) path += (i ? "." : "") + words[i];
  const Key* key = find_key(section, words[depth]);
  if (!key && is_retired(section, words[depth], value, path.empty() ? words[depth] : path + "." + words[depth], where))
    return;
  if (!key)
    throw Error("`" + words[depth] + "` is not a key of " + (path.empty() ? "the file" : "`" + path + "`"), where,
                "allowed: " + joined(key_names(section)) + suggestion(words[depth], key_names(section)));
  if (depth + 1 == words.size()) {
    node[key->name] = value;
    return;
  }
  YAML::Node child = node[key->name];
  std::size_t next = depth + 1;
  if (key->kind == Kind::sections) {
    if (!child.IsSequence()) child = YAML::Node(YAML::NodeType::Sequence);
    const std::size_t item = item_index(child, words[next], path.empty() ? key->name : path + "." + key->name, where);
    child.reset(child[item]);
    words[next] = std::to_string(item);
    if (++next == words.size()) {
      child = value;
      return;
    }
  } else if (key->kind != Kind::section) {
    throw Error("`" + words[depth] + "` has no keys in it", where, "end the key there");
  }
  if (child.IsScalar() && !key->section->shorthand.empty()) {
    const YAML::Node plain = YAML::Clone(child);
    child = YAML::Node(YAML::NodeType::Map);
    child[key->section->shorthand] = plain;
  }
  if (!child.IsMap()) child = YAML::Node(YAML::NodeType::Map);
  assign(child, *key->section, words, next, value, where);
}

void emit(YAML::Emitter& out, const Config& config);

void emit_value(YAML::Emitter& out, const Config& entry) {
  if (entry.section && entry.key->kind == Kind::section) return emit(out, entry);
  if (entry.key->kind == Kind::sections) {
    out << YAML::BeginSeq;
    for (const Config& item : entry.items) emit(out, item);
    out << YAML::EndSeq;
    return;
  }
  const bool list = names_of(entry.key->kind).list;
  if (list) out << YAML::Flow << YAML::BeginSeq;
  for (const double number : entry.numbers) {
    if (entry.key->kind == Kind::boolean)
      out << (number != 0);
    else
      out << fmt::format("{}", number);
  }
  for (const std::string& word : entry.words) {
    // Text that would read back as a number or a boolean is quoted.
    if (entry.key->kind != Kind::number && entry.key->kind != Kind::integer) out << YAML::DoubleQuoted;
    out << word;
  }
  if (list) out << YAML::EndSeq;
}

void emit(YAML::Emitter& out, const Config& config) {
  out << YAML::BeginMap;
  for (const Config& entry : config.entries) {
    if (!entry.present()) continue;
    out << YAML::Key << entry.key->name << YAML::Value;
    emit_value(out, entry);
  }
  out << YAML::EndMap;
}

constexpr int most_values = 4'000'000, deepest = 200;  // of a file

// Takes what a reader of the tree comes to from `left`, aliases as often as they stand there: a few thousand bytes of
// them can stand for more values than any machine holds.
void count_values(const YAML::Node& node, const std::string& file, int depth, int& left) {
  if (--left < 0)
    throw Error(fmt::format("has more than {} values, with what its aliases repeat", most_values), file,
                "leave aliases (`*name`) of aliases out, or put lists into files of their own");
  if (depth > deepest) throw Error(fmt::format("is nested more than {} deep", deepest), file, "nest less");
  if (node.IsSequence())
    for (const YAML::Node& item : node) count_values(item, file, depth + 1, left);
  if (node.IsMap())
    for (const auto& pair : node) count_values(pair.second, file, depth + 1, left);
}

// Writes one key=value into the tree; plain values that stand for sections become sections on the way.
void apply_override(const std::string& assignment, YAML::Node root, const Section& section, Origin& origin) {
  const std::string where = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error("is not key=value", where, "write for example --set run.frames=10");
  std::vector<std::string> words{""};
  for (const char c : assignment.substr(0, equals)) {
    if (c == '.')
      words.emplace_back();
    else
      words.back() += c;
  }
  if (assignment.find_first_not_of(' ', equals + 1) == std::string::npos)
    throw Error("has no value", where, "write `null` for the default, or \"\" for an empty text");
  const YAML::Node value = loaded(assignment.substr(equals + 1), where);
  assign(root, section, words, 0, value, where);
  origin.overrides.push_back({fmt::format("{}", fmt::join(words, ".")), where});
}

}  // namespace

std::string Origin::of(const YAML::Node& node, const std::string& path, const std::string& parent) const {
  for (auto o = overrides.rbegin(); o != overrides.rend(); ++o)
    if (path == o->path || path.starts_with(o->path + ".")) return o->where;
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? parent : fmt::format("{}:{}", file, mark.line + 1);
}

const Key* find_key(const Section& section, std::string_view name) {
  for (const Key& key : section.keys)
    if (key.name == name) return &key;
  return nullptr;
}

std::vector<std::string> key_names(const Section& section) {
  std::vector<std::string> names;
  for (const Key& key : section.keys) names.push_back(key.name);
  return names;
}

Config read_config(const std::filesystem::path& path, const Section& section,
                   const std::vector<std::string>& overrides) {
  Origin origin{path.string(), {}};
  try {
    YAML::Node root = loaded(read_text_file(path, "configuration"), origin.file);
    const std::string cure = "write `key: value`; allowed keys: " + joined(key_names(section));
    if (root.IsNull()) throw Error("is empty", origin.file, cure);
    if (!root.IsMap()) throw Error("is not a list of `key: value`", origin.file, cure);
    int left = most_values;
    count_values(root, origin.file, 0, left);
    expand_aliases(root);
    for (const std::string& assignment : overrides) apply_override(assignment, root, section, origin);
    return checked_section(root, section, "", origin.file, origin);
  } catch (const YAML::Exception& e) {
    throw Error("cannot be read: " + e.msg, origin.file, "");
  }
}

Config read_values(const Section& section, const std::vector<GivenValue>& values) {
  Origin origin{"the command line", {}};
  YAML::Node root(YAML::NodeType::Map);
  for (const GivenValue& given : values) {
    if (given.words.size() == 1)
      root[given.key] = given.words[0];
    else
      root[given.key] = given.words;
    origin.overrides.push_back({given.key, given.where});
  }
  return checked_section(root, section, "", origin.file, origin);
}

Config read_section(const std::string& yaml, const Section& section, const std::string& where) {
  Origin origin{where, {}};
  const YAML::Node root = loaded(yaml, where);
  if (!root.IsMap()) throw Error("is no dictionary", where, "allowed keys: " + joined(key_names(section)));
  int left = most_values;
  count_values(root, where, 0, left);
  for (const auto& pair : root) origin.overrides.push_back({pair.first.Scalar(), where});
  return checked_section(root, section, "", where, origin);
}

std::map<std::string, std::string> top_keys(const std::filesystem::path& file, const std::string& noun) {
  const YAML::Node root = loaded(read_text_file(file, noun), file.string());
  if (!root.IsMap()) throw Error("is not a list of `key: value`", file.string(), "write each key on a line of its own");
  std::map<std::string, std::string> keys;
  for (const auto& pair : root)
    if (pair.first.IsScalar()) keys[pair.first.Scalar()] = pair.second.IsScalar() ? pair.second.Scalar() : "";
  return keys;
}

std::string quoted_yaml(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

std::string to_yaml(const Config& config) {
  YAML::Emitter out;
  emit(out, config);
  return std::string(out.c_str()) + "\n";
}

}  // namespace selvedge
