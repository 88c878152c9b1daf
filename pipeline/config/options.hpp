#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "pipeline/config/config_tables.hpp"

// Keys that are bound to members of a struct. One row of a table reads the key, takes its default from the struct's
// initialiser, documents it and prints it. The struct does not describe such members a second time:
//
//   const Options<TrainingOptions>& training_options() {
//     using O = TrainingOptions;
//     static const Options<O> table("training", "", {
//         number("learning_rate", &O::learning_rate, Unit::none, positive, "Learning rate of Adam."),
//         integer("batch", &O::batch, at_least_one, "Number of samples in a step."),
//         choice("loss", &O::loss, {{"physics", Loss::physics}, {"squares", Loss::squares}}, "What is minimised.")});
//     return table;
//   }
//   const TrainingOptions options = training_options().read(config["training"]);
//
// A plain Key may stand between the rows: the section has it, and whoever reads the section reads it.
namespace selvedge {

template <class Struct>
struct Option {
  Key key;
  std::function<void(const Config& entry, Struct&)> read{};  // empty: the key is not bound
  std::function<void(const Struct&, Config& entry)> write{};
  Option(Key k) : key(std::move(k)) {}  // NOLINT: keys are meant to stand among options
};

template <class Struct>
using OptionRows = std::vector<Option<Struct>>;

// An entry's value, to and from the type of a member; an entry without a number is an empty optional, and an empty
// optional or text is an entry without a value, or with the word that stands for it.
void take(const Config& entry, double&);
void take(const Config& entry, int&);
void take(const Config& entry, std::uint64_t&);
void take(const Config& entry, bool&);
void take(const Config& entry, std::string&);
void take(const Config& entry, Vec3&);
void take(const Config& entry, std::vector<double>&);
void take(const Config& entry, std::vector<std::string>&);
void put(double, Config& entry);
void put(int, Config& entry);
void put(std::uint64_t, Config& entry);
void put(bool, Config& entry);
void put(const std::string&, Config& entry);
void put(const Vec3&, Config& entry);
void put(const std::vector<double>&, Config& entry);
void put(const std::vector<std::string>&, Config& entry);

template <class T>
void take(const Config& entry, std::optional<T>& value) {
  value.reset();
  if (!entry.numbers.empty()) take(entry, value.emplace());
}
template <class T>
void put(const std::optional<T>& value, Config& entry) {
  entry.numbers.clear();
  entry.words = value ? std::vector<std::string>{} : entry.key->choices;
  if (value) put(*value, entry);
}

// An entry's value as it stands as a default in a table; empty where it has none.
std::string default_text(const Config& entry);
// A section with an entry for every key, none of which has a value.
Config empty_section(const Section&);

template <class Struct>
std::vector<Key> keys_of(const OptionRows<Struct>& rows) {
  std::vector<Key> keys;
  for (const Option<Struct>& row : rows) keys.push_back(row.key);
  return keys;
}

// What the section gives replaces what the struct holds.
template <class Struct>
void read_options(const OptionRows<Struct>& rows, const Config& section, Struct& options) {
  for (const Option<Struct>& row : rows)
    if (const Config& entry = section[row.key.name]; row.read && entry.given) row.read(entry, options);
}

// The section's entries then say what the struct holds.
template <class Struct>
void write_options(const OptionRows<Struct>& rows, const Struct& options, Config& section) {
  for (const Option<Struct>& row : rows)
    if (row.write) row.write(options, section[row.key.name]);
}

// A section of a configuration file, bound to a struct. Keys of other sections may point to it: it stays where it is.
template <class Struct>
struct Options {
  const OptionRows<Struct> rows;
  const Section section;

  Options(std::string name, std::string about, OptionRows<Struct> all, std::string shorthand = {},
          std::vector<std::string> exactly_one = {}, std::vector<RetiredKey> retired = {})
      : rows(std::move(all)), section{std::move(name),      std::move(about),       keys_of(rows),
                                      std::move(shorthand), std::move(exactly_one), std::move(retired)} {}
  Options(const Options&) = delete;
  Options& operator=(const Options&) = delete;

  // The struct as it is made, with what the section gives.
  Struct read(const Config& given) const {
    Struct options;
    read_options(rows, given, options);
    return options;
  }
  // The section that reads back to the struct.
  Config written(const Struct& options) const {
    Config config = empty_section(section);
    write_options(rows, options, config);
    return config;
  }
};

namespace table {

template <class T, class... Kinds>
concept one_of = (std::same_as<T, Kinds> || ...);

template <class Struct>
Option<Struct> with_default(Option<Struct> option) {
  Config entry;
  entry.key = &option.key;
  option.write(Struct{}, entry);
  option.key.otherwise = default_text(entry);
  return option;
}

template <class Struct, class T>
Option<Struct> bound(T Struct::*member, Key key) {
  Option<Struct> option(std::move(key));
  option.read = [member](const Config& entry, Struct& options) { take(entry, options.*member); };
  option.write = [member](const Struct& options, Config& entry) { put(options.*member, entry); };
  return with_default(std::move(option));
}

template <class Struct, one_of<double, std::optional<double>> T>
Option<Struct> number(std::string name, T Struct::*member, Unit unit, Range range, std::string about) {
  return bound(member, number(std::move(name), unit, range, {}, std::move(about)));
}
template <class Struct, one_of<int, std::uint64_t, std::optional<int>> T>
Option<Struct> integer(std::string name, T Struct::*member, Range range, std::string about) {
  return bound(member, integer(std::move(name), range, {}, std::move(about)));
}
template <class Struct>
Option<Struct> flag(std::string name, bool Struct::*member, std::string about) {
  return bound(member, flag(std::move(name), false, std::move(about)));
}
template <class Struct>
Option<Struct> text(std::string name, std::string Struct::*member, std::string about) {
  return bound(member, text(std::move(name), std::move(about)));
}
template <class Struct>
Option<Struct> path(std::string name, std::string Struct::*member, std::string about) {
  return bound(member, path(std::move(name), std::move(about)));
}
template <class Struct>
Option<Struct> word(std::string name, std::string Struct::*member, std::vector<std::string> choices,
                    std::string about) {
  return bound(member, word(std::move(name), std::move(choices), {}, std::move(about)));
}
template <class Struct, one_of<Vec3, std::optional<Vec3>> T>
Option<Struct> vector(std::string name, T Struct::*member, Unit unit, std::string about) {
  return bound(member, vector(std::move(name), unit, {}, std::move(about)));
}
template <class Struct>
Option<Struct> numbers(std::string name, std::vector<double> Struct::*member, Range range, std::string about) {
  return bound(member, numbers(std::move(name), range, std::move(about)));
}
template <class Struct>
Option<Struct> texts(std::string name, std::vector<std::string> Struct::*member, std::string about) {
  return bound(member, texts(std::move(name), std::move(about)));
}

// One of an enum's values, each by its word.
template <class Struct, class Value>
Option<Struct> choice(std::string name, Value Struct::*member,
                      std::type_identity_t<std::vector<std::pair<std::string, Value>>> values, std::string about) {
  std::vector<std::string> words;
  for (const auto& [text, value] : values) words.push_back(text);
  Option<Struct> option(word(std::move(name), std::move(words), {}, std::move(about)));
  option.read = [member, values](const Config& entry, Struct& options) {
    for (const auto& [text, value] : values)
      if (text == entry.text()) options.*member = value;
  };
  option.write = [member, values](const Struct& options, Config& entry) {
    for (const auto& [text, value] : values)
      if (value == options.*member) entry.words = {text};
  };
  return with_default(std::move(option));
}

// A section in the section, with the struct's member that it is bound to.
template <class Struct, class Part>
Option<Struct> section(Part Struct::*member, const Options<Part>& part, std::string about) {
  Option<Struct> option(section(part.section, "{}", std::move(about)));
  option.read = [member, &part](const Config& entry, Struct& options) {
    read_options(part.rows, entry, options.*member);
  };
  option.write = [member, &part](const Struct& options, Config& entry) {
    write_options(part.rows, options.*member, entry);
  };
  return option;
}

// Rows of a member, as rows of the struct: their keys stand in the struct's own section.
template <class Struct, class Part>
OptionRows<Struct> inside(Part Struct::*member, const OptionRows<Part>& rows) {
  OptionRows<Struct> own;
  for (const Option<Part>& row : rows) {
    Option<Struct>& option = own.emplace_back(row.key);
    if (!row.read) continue;
    option.read = [member, row](const Config& entry, Struct& options) { row.read(entry, options.*member); };
    option.write = [member, row](const Struct& options, Config& entry) { row.write(options.*member, entry); };
    if (!row.key.section && !row.key.required) option = with_default(std::move(option));
  }
  return own;
}

// An optional number that the word stands for while it is empty: "auto".
template <class Struct>
Option<Struct> or_word(Option<Struct> option, std::string word) {
  option.key.choices = {std::move(word)};
  return with_default(std::move(option));
}
// A section under a name of its own. What a file leaves out of it keeps the struct's value.
template <class Struct>
Option<Struct> renamed(Option<Struct> option, std::string name) {
  option.key.name = std::move(name);
  return option;
}
template <class Struct>
Option<Struct> needed(Option<Struct> option) {
  option.key.otherwise.clear();
  option.key.required = true;
  return option;
}

template <class Struct>
OptionRows<Struct> operator+(OptionRows<Struct> a, const OptionRows<Struct>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace table
}  // namespace selvedge
