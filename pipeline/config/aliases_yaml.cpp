#include "pipeline/config/aliases_yaml.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace selvedge {
namespace {

// Where a value of the file begins, and of which type it is: an alias has both of what it names.
using Places = std::set<std::pair<int, YAML::NodeType::value>>;

void merge(const YAML::Node& from, YAML::Node into) {
  for (const auto& pair : from)
    if (const YAML::Node& known = into; pair.first.IsScalar() && !known[pair.first.Scalar()].IsDefined())
      into.force_insert(pair.first, YAML::Clone(pair.second));
}

bool can_merge(const YAML::Node& from) {
  if (!from.IsSequence()) return from.IsMap();
  for (const YAML::Node& item : from)
    if (!item.IsMap()) return false;
  return true;
}

void merge_keys(YAML::Node map) {
  const std::string key = "<<";
  const YAML::Node from = std::as_const(map)[key];
  if (!from.IsDefined() || !can_merge(from)) return;
  map.remove(key);
  if (from.IsMap()) merge(from, map);
  for (std::size_t i = 0; from.IsSequence() && i < from.size(); ++i) merge(from[i], map);
}

// False for an alias.
bool first_time(const YAML::Node& node, Places& seen) {
  return node.IsNull() || seen.emplace(node.Mark().pos, node.Type()).second;
}

void expand(YAML::Node node, Places& seen);

// What an alias names stands before it and is expanded, so that a copy has no aliases. Assignment would change what the
// alias names: an item takes the place of another by being put in again.
void expand_items(YAML::Node list, Places& seen) {
  std::vector<YAML::Node> items;
  bool aliases = false;
  for (const YAML::Node& item : list) {
    const bool alias = !first_time(item, seen);
    items.push_back(alias ? YAML::Clone(item) : item);
    if (!alias) expand(item, seen);
    aliases = aliases || alias;
  }
  while (aliases && list.size() > 0) list.remove(list.size() - 1);
  for (std::size_t i = 0; aliases && i < items.size(); ++i) list.push_back(items[i]);
}

void expand_values(YAML::Node map, Places& seen) {
  std::vector<std::pair<YAML::Node, YAML::Node>> aliases;
  for (const auto& pair : map) {
    if (first_time(pair.second, seen))
      expand(pair.second, seen);
    else
      aliases.emplace_back(pair.first, YAML::Clone(pair.second));
  }
  for (const auto& [key, value] : aliases) {
    map.remove(key);
    map.force_insert(key, value);
  }
  merge_keys(map);
}

void expand(YAML::Node node, Places& seen) {
  if (node.IsSequence()) expand_items(node, seen);
  if (node.IsMap()) expand_values(node, seen);
}

}  // namespace

void expand_aliases(YAML::Node root) {
  Places seen;
  expand(root, seen);
}

}  // namespace selvedge
