#include "learned/network/architecture_text.hpp"

#include <charconv>
#include <map>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "learned/graph/feature_tables.hpp"

namespace selvedge {
namespace {

// The limit of entries in a list; longer lists are refused before memory is allocated.
constexpr int most_entries = 1024;

template <class Number>
std::string number_text(Number number) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream words(text);
  std::vector<std::string> all;
  for (std::string word; words >> word;) all.push_back(word);
  return all;
}

// Appends one line per field.
struct FieldWriter {
  std::string text;

  void line(const std::string& field, const std::string& value) { text += field + ": " + value + "\n"; }
  void operator()(const std::string& field, int value) { line(field, number_text(value)); }
  void operator()(const std::string& field, bool value) { line(field, value ? "yes" : "no"); }
  void operator()(const std::string& field, double value) { line(field, number_text(value)); }
  void operator()(const std::string& field, const std::string& value) { line(field, value); }
  void operator()(const std::string& field, const std::vector<int>& values) {
    std::vector<std::string> words;
    for (const int value : values) words.push_back(number_text(value));
    line(field, joined(words));
  }
  template <class Choice>
  void operator()(const std::string& field, Choice value, const std::vector<std::string>& names) {
    line(field, names.at(static_cast<std::size_t>(value)));
  }
  template <class Entry>
  void operator()(const std::string& field, const std::vector<Entry>& entries) {
    (*this)(field, static_cast<int>(entries.size()));
  }
  // A field that older texts lack: it is written only where it differs from what they mean.
  template <class Value, class... Names>
  void later(const std::string& field, Value value, Value of_old, const Names&... names) {
    if (value != of_old) (*this)(field, value, names...);
  }
};

// Parses the lines of a text and gives each field once.
class FieldReader {
 public:
  FieldReader(const std::string& text, std::string where) : where_(std::move(where)) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      if (colon == std::string::npos) fail(line.substr(0, 60), "the line is not `field: value`");
      if (!fields_.emplace(line.substr(0, colon), line.substr(colon + 2)).second)
        fail(line.substr(0, colon), "it is given twice");
    }
  }
  [[noreturn]] void fail(const std::string& field, const std::string& what) const {
    throw Error("the architecture cannot be read: " + what, where_ + ": " + field, "write the file again");
  }
  std::string take(const std::string& field) {
    const auto found = fields_.find(field);
    if (found == fields_.end()) fail(field, "it is missing");
    std::string value = std::move(found->second);
    fields_.erase(found);
    return value;
  }
  template <class Number>
  Number number(const std::string& field, const std::string& word) const {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || word.empty())
      fail(field, "`" + word.substr(0, 60) + "` is no number of its kind");
    return value;
  }
  void expect_end() const {
    if (!fields_.empty()) fail(fields_.begin()->first.substr(0, 60), "no such field is known");
  }

  void operator()(const std::string& field, int& value) { value = number<int>(field, take(field)); }
  void operator()(const std::string& field, double& value) { value = number<double>(field, take(field)); }
  void operator()(const std::string& field, std::string& value) { value = take(field); }
  void operator()(const std::string& field, bool& value) {
    const std::string word = take(field);
    if (word != "yes" && word != "no") fail(field, "it is neither yes nor no");
    value = word == "yes";
  }
  void operator()(const std::string& field, std::vector<int>& values) {
    values.clear();
    for (const std::string& word : split(take(field))) values.push_back(number<int>(field, word));
  }
  template <class Choice>
  void operator()(const std::string& field, Choice& value, const std::vector<std::string>& names) {
    const std::string word = take(field);
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == word) {
        value = static_cast<Choice>(i);
        return;
      }
    fail(field, "it must be one of " + joined(names));
  }
  template <class Entry>
  void operator()(const std::string& field, std::vector<Entry>& entries) {
    const int count = number<int>(field, take(field));
    if (count < 0 || count > most_entries) fail(field, std::to_string(count) + " is no possible count");
    entries.resize(static_cast<std::size_t>(count));
  }
  template <class Value, class... Names>
  void later(const std::string& field, Value& value, Value of_old, const Names&... names) {
    value = of_old;
    if (fields_.contains(field)) (*this)(field, value, names...);
  }

 private:
  std::string where_;
  std::map<std::string, std::string> fields_;
};

template <class Visitor, class Size>
void visit_table(Visitor& visit, const std::string& name, Size& table) {
  visit(name + ".rows", table.rows);
  visit(name + ".columns", table.columns);
}

// Visits every field that is one value, in the order of the text. `visit` reads or writes.
template <class Visitor, class Options>
void visit_features(Visitor& visit, Options& f) {
  visit("features.type_columns", f.type_columns);
  visit("features.level_columns", f.level_columns);
  visit("features.highest_level", f.highest_level);
  visit("features.log_mass", f.log_mass);
  visit("features.time", f.time, {"timestep", "is_init"});
  visit("features.cloth_velocity", f.cloth_velocity, {"carried", "difference"});
  visit("features.body_velocity", f.body_velocity, {"current", "next"});
  visit("features.pinned", f.pinned, {"moved", "moved_for_mesh_edges"});
  visit("features.pinned_flag", f.pinned_flag);
  visit("features.body_inputs", f.body_inputs);
  visit("features.force_inputs", f.force_inputs);
  visit("features.pass_inputs", f.pass_inputs);
  visit("features.contour_force", f.contour_force);
  visit("features.strain_inputs", f.strain_inputs);
  visit("features.edge_context", f.edge_context);
  visit("features.mesh_order", f.mesh_order, {"larger_sends", "smaller_sends"});
  visit("features.rest", f.rest, {"vector", "length"});
  visit("features.coarse_levels", f.coarse_levels);
  visit("features.coarse_sets", f.coarse_sets);
  visit("features.coarse_form", f.coarse_form, {"depths", "discs"});
  visit("features.shared_mesh_statistics", f.shared_mesh_statistics);
  visit("features.approximate_centre", f.approximate_centre);
  visit("features.body_key", f.body_key);
  visit("features.body_partner", f.body_partner, {"nearest_vertex", "nearest_face"});
  visit("features.body_radius", f.body_radius);
  visit("features.next_body_first", f.next_body_first);
  visit("features.body_edge_velocity", f.body_edge_velocity);
  visit("features.cloth_edges", f.cloth_edges);
  visit("features.cloth_radius", f.cloth_radius);
  visit("features.cloth_pairs_per_vertex", f.cloth_pairs_per_vertex);
  visit("features.future_pinned", f.future_pinned);
  visit("features.label_columns", f.label_columns);
  visit("features.contours", f.contours, {"all_repel", "vertex", "all_vertices"});
  visit("features.attraction_edges", f.attraction_edges);
  visit("features.acceleration_inputs", f.acceleration_inputs);
  visit("features.space_edges", f.space_edges);
  visit("features.space.radius", f.space.radius);
  visit("features.space.radius_in_edges", f.space.radius_in_edges);
  visit("features.space.mesh_pairs", f.space.mesh_pairs);
  visit("features.space.rest_pairs", f.space.rest_pairs);
  visit("features.space.nearest", f.space.nearest);
  visit("features.space.pairs_per_vertex", f.space.pairs_per_vertex);
  visit.later("features.base", f.base, OutputBase::motion, std::vector<std::string>{"motion", "carried"});
  visit.later("features.guess_inputs", f.guess_inputs, false);
}

template <class Visitor, class Value>
void visit_values(Visitor& visit, Value& a) {
  visit("name", a.name);
  visit("width", a.width);
  visit("hidden_layers", a.hidden_layers);
  visit("layer_norm", a.layer_norm);
  visit("node_inputs", a.node_inputs);
  visit("outputs", a.outputs);
  visit("integration", a.integration, {"relaxation_frame", "start_flag"});
  visit("passes", a.passes);
  visit_table(visit, "node_type", a.node_type);
  visit_table(visit, "vertex_level", a.vertex_level);
  visit_table(visit, "edge_type", a.edge_type);
  visit_statistics([&visit](const std::string& set, auto& size) { visit("statistics." + set, size); }, a.statistics);
  visit_features(visit, a.features);
  visit("encoders", a.encoders);
  visit("edge_kinds", a.edge_kinds);
  visit("steps", a.steps);
}

std::string entry(const std::string& list, std::size_t i) { return list + "." + std::to_string(i); }

// "world_edge near coarse_edge0 coarse_edge1"
EdgeFilter parse_filter(const FieldReader& reader, const std::string& field, const std::string& text) {
  const std::vector<std::string> words = split(text);
  if (words.size() < 2 || words[1] != "near") reader.fail(field, "a filter is `key near keys`");
  return {words[0], {words.begin() + 2, words.end()}};
}

MessageStep parse_step(const FieldReader& reader, const std::string& field, const std::string& text) {
  std::istringstream parts(text);
  std::string part;
  std::getline(parts, part, '|');
  MessageStep step{split(part), {}};
  while (std::getline(parts, part, '|')) step.filters.push_back(parse_filter(reader, field, part));
  return step;
}

}  // namespace

std::string architecture_text(const Architecture& a) {
  check_architecture(a, a.name);
  FieldWriter writer;
  visit_values(writer, a);
  for (std::size_t i = 0; i < a.encoders.size(); ++i)
    writer.line(entry("encoder", i), a.encoders[i].name + " " + number_text(a.encoders[i].inputs));
  for (std::size_t i = 0; i < a.edge_kinds.size(); ++i)
    writer.line(entry("edge_kind", i), a.edge_kinds[i].key + " " + number_text(a.edge_kinds[i].encoder) + " " +
                                           number_text(a.edge_kinds[i].normalised));
  for (std::size_t i = 0; i < a.steps.size(); ++i) {
    std::string line = joined(a.steps[i].edge_keys);
    for (const EdgeFilter& filter : a.steps[i].filters) line += " | " + filter.key + " near " + joined(filter.near);
    writer.line(entry("step", i), line);
  }
  return writer.text;
}

Architecture parse_architecture(const std::string& text, const std::string& where) {
  FieldReader reader(text, where);
  Architecture a;
  visit_values(reader, a);
  for (std::size_t i = 0; i < a.encoders.size(); ++i) {
    const std::string field = entry("encoder", i);
    const std::vector<std::string> words = split(reader.take(field));
    if (words.size() != 2) reader.fail(field, "it is not `name inputs`");
    a.encoders[i] = {words[0], reader.number<int>(field, words[1])};
  }
  for (std::size_t i = 0; i < a.edge_kinds.size(); ++i) {
    const std::string field = entry("edge_kind", i);
    const std::vector<std::string> words = split(reader.take(field));
    if (words.size() != 3) reader.fail(field, "it is not `key encoder normalised`");
    a.edge_kinds[i] = {words[0], reader.number<int>(field, words[1]), reader.number<int>(field, words[2])};
  }
  for (std::size_t i = 0; i < a.steps.size(); ++i)
    a.steps[i] = parse_step(reader, entry("step", i), reader.take(entry("step", i)));
  reader.expect_end();
  check_architecture(a, where);
  return a;
}

}  // namespace selvedge
