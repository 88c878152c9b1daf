#include "pipeline/weights/pickle_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

constexpr std::int64_t deepest_nesting = 100, most_unfolded = 20'000'000;

// The size of a value with everything that it contains.
struct Unfolded {
  enum class State { unseen, open, closed } state = State::unseen;
  std::int64_t depth = 1, count = 1;  // count: values if everything shared is written out
};

std::vector<PickleIndex> held_by(const PickleValue& value) {
  if (const auto* list = std::get_if<PickleList>(&value)) return list->items;
  if (const auto* tuple = std::get_if<PickleTuple>(&value)) return tuple->items;
  std::vector<PickleIndex> held;
  if (const auto* dict = std::get_if<PickleDict>(&value))
    for (const auto& [key, entry] : dict->entries) {
      held.push_back(key);
      held.push_back(entry);
    }
  return held;
}

void refuse_repeated_keys(const Pickle& pickle, const PickleDict& dict, const std::string& where) {
  std::vector<std::string_view> texts;
  std::vector<std::int64_t> integers;
  for (const auto& [key, entry] : dict.entries)
    if (const auto* text = std::get_if<std::string>(&pickle.values[key]))
      texts.push_back(*text);
    else
      integers.push_back(std::get<std::int64_t>(pickle.values[key]));
  std::ranges::sort(texts);
  std::ranges::sort(integers);
  if (const auto twice = std::ranges::adjacent_find(texts); twice != texts.end())
    refuse_pickle("has the key " + shown(*twice) + " twice in one dictionary", where);
  if (const auto twice = std::ranges::adjacent_find(integers); twice != integers.end())
    refuse_pickle(fmt::format("has the key {} twice in one dictionary", *twice), where);
}

void check_one(const Pickle& pickle, const PickleValue& value, const std::string& where) {
  if (std::holds_alternative<PickleGlobal>(value)) refuse_pickle("holds a global as a value", where);
  if (std::holds_alternative<TorchStorage>(value)) refuse_pickle("holds a storage without a tensor", where);
  if (const auto* dict = std::get_if<PickleDict>(&value)) refuse_repeated_keys(pickle, *dict, where);
}

}  // namespace

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 120;
  std::string line;
  for (const char c : text.substr(0, longest)) line += c >= ' ' && c <= '~' ? std::string(1, c) : "?";
  return text.size() > longest ? line + ".." : line;
}

void refuse_pickle(const std::string& what, const std::string& where) {
  throw Error(what, where,
              "selvedge reads what torch.save makes of a dictionary of tensors and plain settings, and nothing else; "
              "docs/weights.md says how such a file is made");
}

void check_pickle(const Pickle& pickle, const std::string& where) {
  // Depth first with an explicit stack. A value is counted after everything that it contains.
  struct Visit {
    PickleIndex value;
    std::vector<PickleIndex> held;
    std::size_t next = 0;
  };
  std::vector<Unfolded> known(pickle.values.size());
  std::vector<Visit> open;
  const auto enter = [&](PickleIndex value) {
    check_one(pickle, pickle.values[value], where);
    known[value].state = Unfolded::State::open;
    open.push_back({value, held_by(pickle.values[value])});
    if (static_cast<std::int64_t>(open.size()) > deepest_nesting)
      refuse_pickle(fmt::format("nests deeper than {}", deepest_nesting), where);
  };
  enter(pickle.root);
  while (!open.empty()) {
    Visit& visit = open.back();
    Unfolded& mine = known[visit.value];
    if (visit.next == visit.held.size()) {
      mine.state = Unfolded::State::closed;
      open.pop_back();
      continue;
    }
    const PickleIndex value = visit.held[visit.next];
    const Unfolded& theirs = known[value];
    if (theirs.state == Unfolded::State::open) refuse_pickle("has a value that contains itself", where);
    if (theirs.state == Unfolded::State::unseen) {
      enter(value);
      continue;  // it is added after it is closed
    }
    ++visit.next;
    mine.depth = std::max(mine.depth, theirs.depth + 1);
    mine.count += theirs.count;
    if (mine.depth > deepest_nesting) refuse_pickle(fmt::format("nests deeper than {}", deepest_nesting), where);
    if (mine.count > most_unfolded) refuse_pickle(fmt::format("unfolds to more than {} values", most_unfolded), where);
  }
}

}  // namespace selvedge
