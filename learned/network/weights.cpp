#include "learned/network/weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "learned/network/uniform_numbers.hpp"

namespace selvedge {
namespace {

Perceptron blank_perceptron(const Architecture& a, int inputs, int outputs, bool norm) {
  Perceptron perceptron;
  for (int layer = 0; layer <= a.hidden_layers; ++layer) {
    const int in = layer == 0 ? inputs : a.width, out = layer == a.hidden_layers ? outputs : a.width;
    perceptron.layers.push_back({FeatureRows::Zero(out, in), std::vector<float>(out, 0.f)});
  }
  if (norm && a.layer_norm) perceptron.scale.assign(outputs, 1.f), perceptron.shift.assign(outputs, 0.f);
  return perceptron;
}

Statistics blank_statistics(int columns) {
  return {std::vector<float>(columns, 0.f), std::vector<float>(columns, 1.f)};
}

FeatureRows blank_table(const TableSize& size) { return FeatureRows::Zero(size.rows, size.columns); }

// Lists the arrays of weights of any shape.
class ArrayList {
 public:
  std::vector<WeightArray> arrays;

  void add(const std::string& name, FeatureRows& matrix, int inputs) {
    arrays.push_back(
        {name, matrix.data(), static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()), inputs, true});
  }
  void add(const std::string& name, std::vector<float>& vector, int inputs, bool trained) {
    arrays.push_back({name, vector.data(), static_cast<int>(vector.size()), 1, inputs, trained});
  }
  void add(const std::string& name, Perceptron& p) {
    for (std::size_t layer = 0; layer < p.layers.size(); ++layer) {
      const std::string prefix = name + "/layer" + std::to_string(layer);
      const int inputs = static_cast<int>(p.layers[layer].weight.cols());
      add(prefix + "/weight", p.layers[layer].weight, inputs);
      add(prefix + "/bias", p.layers[layer].bias, inputs, true);
    }
    if (p.scale.empty() && p.shift.empty()) return;
    add(name + "/norm/scale", p.scale, 0, true);
    add(name + "/norm/shift", p.shift, 0, true);
  }
  void add(const std::string& name, Statistics& statistics) {
    if (statistics.mean.empty() && statistics.deviation.empty()) return;
    add(name + "/mean", statistics.mean, 0, false);
    add(name + "/deviation", statistics.deviation, 0, false);
  }
  void add_table(const std::string& name, FeatureRows& table) {
    if (table.size() > 0) add(name, table, 0);
  }
};

std::string number_of(std::size_t step) {
  char text[24];
  std::snprintf(text, sizeof text, "%03zu", step);
  return text;
}

}  // namespace

NetworkWeights blank_weights(const Architecture& a) {
  NetworkWeights w;
  w.node_encoder = blank_perceptron(a, a.node_inputs, a.width, true);
  for (const EdgeEncoder& encoder : a.encoders)
    w.encoders.push_back(blank_perceptron(a, encoder.inputs, a.width, true));
  for (const MessageStep& step : a.steps) {
    const int sets = static_cast<int>(step.edge_keys.size());
    w.steps.push_back({std::vector<Perceptron>(sets, blank_perceptron(a, 3 * a.width, a.width, true)),
                       blank_perceptron(a, (1 + sets) * a.width, a.width, true)});
  }
  w.decoder = blank_perceptron(a, a.width, a.outputs, false);
  visit_statistics([](const char*, int columns, Statistics& set) { set = blank_statistics(columns); }, a.statistics,
                   w.tables);
  w.tables.node_type = blank_table(a.node_type);
  w.tables.vertex_level = blank_table(a.vertex_level);
  w.tables.edge_type = blank_table(a.edge_type);
  return w;
}

std::vector<WeightArray> weight_arrays(const Architecture& a, NetworkWeights& w) {
  ArrayList list;
  list.add("node_encoder", w.node_encoder);
  for (std::size_t i = 0; i < w.encoders.size(); ++i)
    list.add("encoders/" + (i < a.encoders.size() ? a.encoders[i].name : std::to_string(i)), w.encoders[i]);
  for (std::size_t i = 0; i < w.steps.size(); ++i) {
    const std::string step = "steps/" + number_of(i);
    for (std::size_t k = 0; k < w.steps[i].edges.size(); ++k) {
      const bool known = i < a.steps.size() && k < a.steps[i].edge_keys.size();
      list.add(step + "/edges/" + (known ? a.steps[i].edge_keys[k] : std::to_string(k)), w.steps[i].edges[k]);
    }
    list.add(step + "/node", w.steps[i].node);
  }
  list.add("decoder", w.decoder);
  FeatureTables& t = w.tables;
  const auto add_statistics = [&list](const std::string& name, Statistics& set) {
    if (name != "output") list.add("statistics/" + name, set);
  };
  visit_statistics(add_statistics, t);
  list.add("statistics/output", t.output);  // last, as in files
  list.add_table("embeddings/node_type", t.node_type);
  list.add_table("embeddings/vertex_level", t.vertex_level);
  list.add_table("embeddings/edge_type", t.edge_type);
  return list.arrays;
}

void check_weights(const Architecture& a, const NetworkWeights& weights, const std::string& where) {
  NetworkWeights wanted = blank_weights(a), given = weights;
  const std::vector<WeightArray> all = weight_arrays(a, wanted), have = weight_arrays(a, given);
  const auto shape = [](const WeightArray& array) {
    return std::to_string(array.rows) + " x " + std::to_string(array.columns);
  };
  const std::string cure = "do the weights belong to this architecture?";
  const auto is_wanted = [&all](const WeightArray& one) {
    return std::any_of(all.begin(), all.end(), [&one](const WeightArray& array) { return array.name == one.name; });
  };
  for (std::size_t i = 0; i < std::max(all.size(), have.size()); ++i) {
    if (i < have.size() && !is_wanted(have[i]))
      throw Error("the architecture has no such array", where + ": " + have[i].name, cure);
    if (i >= have.size() || all[i].name != have[i].name)
      throw Error("the weights lack this array", where + ": " + all[i].name, cure);
    if (all[i].rows != have[i].rows || all[i].columns != have[i].columns)
      throw Error("the array is " + shape(have[i]) + ", the architecture asks for " + shape(all[i]),
                  where + ": " + all[i].name, cure);
  }
}

NetworkWeights random_weights(const Architecture& a, std::uint64_t seed) {
  NetworkWeights weights = blank_weights(a);
  UniformNumbers random(seed);
  for (const WeightArray& array : weight_arrays(a, weights)) {
    const bool table = array.name.starts_with("embeddings/");
    if (!table && array.inputs == 0) continue;  // layer norms and statistics
    const bool bias = array.name.ends_with("/bias");
    const float scale = table ? 1.f : bias ? .1f : std::sqrt(3.f / static_cast<float>(array.inputs));
    for (int i = 0; i < array.rows * array.columns; ++i) array.data[i] = scale * random.in_both_signs();
  }
  return weights;
}

NetworkWeights initial_weights(const Architecture& a, std::uint64_t seed, double last_layer_scale) {
  NetworkWeights weights = blank_weights(a);
  UniformNumbers random(seed);
  // Box and Muller 1958. One number of each pair is used.
  const auto normal = [&random] {
    const double radius = std::sqrt(-2 * std::log(random.in_unit())), turn = 2 * std::numbers::pi * random.in_unit();
    return static_cast<float>(radius * std::cos(turn));
  };
  for (const WeightArray& array : weight_arrays(a, weights)) {
    const bool table = array.name.starts_with("embeddings/");
    if (!table && array.inputs == 0) continue;  // layer norms and statistics
    const float bound = table ? 0.f : 1.f / std::sqrt(static_cast<float>(array.inputs));
    for (int i = 0; i < array.rows * array.columns; ++i)
      array.data[i] = table ? normal() : bound * random.in_both_signs();
  }
  AffineLayer& last = weights.decoder.layers.back();
  last.weight *= static_cast<float>(last_layer_scale);
  for (float& bias : last.bias) bias *= static_cast<float>(last_layer_scale);
  return weights;
}

}  // namespace selvedge
