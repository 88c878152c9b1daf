#include "learned/network/architecture.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "learned/graph/feature_tables.hpp"

namespace selvedge {
namespace {

// The number of weights, biases and layer norms of one perceptron.
long long perceptron_size(const Architecture& a, long long inputs, long long outputs, bool norm) {
  const long long width = a.width;
  return (inputs + 1) * width + (a.hidden_layers - 1) * (width + 1) * width + (width + 1) * outputs +
         (norm && a.layer_norm ? 2 * outputs : 0);
}

long long table_size(const TableSize& table) { return static_cast<long long>(table.rows) * table.columns; }

void require(bool good, const std::string& where, const std::string& field, const std::string& what) {
  if (!good) throw Error("the architecture cannot be built: " + what, where + ": " + field, "write the file again");
}

void require_range(int value, int least, int most, const std::string& where, const std::string& field) {
  require(value >= least && value <= most, where, field,
          std::to_string(value) + " is not in " + std::to_string(least) + " to " + std::to_string(most));
}

// Names become words of a text and paths in a file.
void require_name(const std::string& name, const std::string& where, const std::string& field) {
  const auto good = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  require(!name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), good), where, field,
          "a name has small letters, digits and `_`, 64 at most");
}

void require_table(const TableSize& table, const std::string& where, const std::string& field) {
  require_range(table.rows, 0, 4096, where, field);
  require_range(table.columns, 0, 4096, where, field);
}

void check_step(const Architecture& a, const MessageStep& step, const std::string& where) {
  require_range(static_cast<int>(step.edge_keys.size()), 0, 64, where, "steps");
  require_range(static_cast<int>(step.filters.size()), 0, 64, where, "steps");
  for (std::size_t i = 0; i < step.edge_keys.size(); ++i) {
    require(edge_kind(a, step.edge_keys[i]) >= 0, where, "steps", "no edges of kind " + step.edge_keys[i]);
    require(i == 0 || step.edge_keys[i - 1] < step.edge_keys[i], where, "steps", "the keys are not in order");
  }
  for (const EdgeFilter& filter : step.filters) {
    require(edge_kind(a, filter.key) >= 0, where, "steps", "no edges of kind " + filter.key);
    for (const std::string& key : filter.near)
      require(edge_kind(a, key) >= 0, where, "steps", "no edges of kind " + key);
  }
}

}  // namespace

int edge_kind(const Architecture& a, const std::string& key) {
  for (std::size_t kind = 0; kind < a.edge_kinds.size(); ++kind)
    if (a.edge_kinds[kind].key == key) return static_cast<int>(kind);
  return -1;
}

int encoder_of(const Architecture& a, const std::string& key) {
  return a.edge_kinds[static_cast<std::size_t>(edge_kind(a, key))].encoder;
}

void check_architecture(const Architecture& a, const std::string& where) {
  require_name(a.name, where, "name");
  require_range(a.width, 1, most_latents, where, "width");
  require_range(a.hidden_layers, 1, 16, where, "hidden_layers");
  require_range(a.node_inputs, 1, 4096, where, "node_inputs");
  require_range(a.outputs, 1, 4096, where, "outputs");
  require_range(a.features.coarse_levels, 0, 16, where, "features.coarse_levels");
  require_range(a.passes, 1, 64, where, "passes");
  require_range(static_cast<int>(a.encoders.size()), 0, 64, where, "encoders");
  require_range(static_cast<int>(a.edge_kinds.size()), 0, 64, where, "edge_kinds");
  require_range(static_cast<int>(a.steps.size()), 0, most_message_steps, where, "steps");
  for (const EdgeEncoder& encoder : a.encoders) {
    require_name(encoder.name, where, "encoders");
    require_range(encoder.inputs, 1, 4096, where, "encoders");
    require(std::count_if(a.encoders.begin(), a.encoders.end(),
                          [&encoder](const EdgeEncoder& other) { return other.name == encoder.name; }) == 1,
            where, "encoders", "two have the name " + encoder.name);
  }
  for (const EdgeKind& kind : a.edge_kinds) {
    require_name(kind.key, where, "edge_kinds");
    require_range(kind.encoder, 0, static_cast<int>(a.encoders.size()) - 1, where, "edge_kinds");
    require_range(kind.normalised, 0, a.encoders[kind.encoder].inputs, where, "edge_kinds");
    require(&a.edge_kinds[edge_kind(a, kind.key)] == &kind, where, "edge_kinds", "two kinds have key " + kind.key);
  }
  for (const MessageStep& step : a.steps) check_step(a, step, where);
  require_table(a.node_type, where, "node_type");
  require_table(a.vertex_level, where, "vertex_level");
  require_table(a.edge_type, where, "edge_type");
  visit_statistics([&](const char*, int size) { require_range(size, 0, 4096, where, "statistics"); }, a.statistics);
}

long long parameter_count(const Architecture& a) {
  const long long width = a.width;
  long long count = perceptron_size(a, a.node_inputs, width, true) + perceptron_size(a, width, a.outputs, false);
  for (const EdgeEncoder& encoder : a.encoders) count += perceptron_size(a, encoder.inputs, width, true);
  for (const MessageStep& step : a.steps) {
    const auto sets = static_cast<long long>(step.edge_keys.size());
    count += sets * perceptron_size(a, 3 * width, width, true) + perceptron_size(a, (1 + sets) * width, width, true);
  }
  return count + table_size(a.node_type) + table_size(a.vertex_level) + table_size(a.edge_type);
}

}  // namespace selvedge
