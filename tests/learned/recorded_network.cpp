#include "tests/learned/recorded_network.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <map>

#include "pipeline/formats/npz.hpp"
#include "tests/pipeline/files.hpp"

namespace selvedge::recorded {
namespace {

FeatureRows rows_of(const Npz& file, const std::string& name) {
  const NpyArray<double> array = file.numbers(name);
  const Eigen::Index columns = array.shape.back();
  const auto rows = columns == 0 ? 0 : static_cast<Eigen::Index>(array.values.size()) / columns;
  FeatureRows result(rows, columns);
  for (std::size_t i = 0; i < array.values.size(); ++i) result.data()[i] = static_cast<float>(array.values[i]);
  return result;
}

std::vector<int> index_row(const Npz& file, const std::string& name, int row) {
  const NpyArray<std::int64_t> array = file.integers(name);
  const auto begin = array.values.begin() + row * array.shape[1];
  return {begin, begin + array.shape[1]};
}

// Pairs of garment and body vertices: first all garment -> body, then the same reversed.
EdgeSet body_edges(const Npz& file, const std::string& name, int cloth_nodes) {
  const std::vector<int> garment = index_row(file, name + "_edge_index", 0);
  std::vector<int> body = index_row(file, name + "_edge_index", 1);
  std::map<int, int> node_of;
  for (const std::int64_t vertex : file.integers("body_active_index").values)
    node_of.emplace(static_cast<int>(vertex), cloth_nodes + static_cast<int>(node_of.size()));
  for (int& vertex : body) vertex = node_of.at(vertex);
  EdgeSet set;
  set.key = name + "_edge";
  set.senders = garment;
  set.receivers = body;
  set.features = rows_of(file, name + "_features");
  set.senders.insert(set.senders.end(), body.begin(), body.end());
  set.receivers.insert(set.receivers.end(), garment.begin(), garment.end());
  return set;
}

// Numbers of the formula, in the order of the state dict.
class Formula {
 public:
  explicit Formula(std::uint64_t seed) : seed_(seed) {}
  void fill(float* data, Eigen::Index size, float scale, float offset = 0) {
    for (Eigen::Index i = 0; i < size; ++i) data[i] = offset + scale * next();
  }
  void fill(Perceptron& p) {
    for (AffineLayer& layer : p.layers) {
      const auto inputs = static_cast<double>(layer.weight.cols());
      fill(layer.weight.data(), layer.weight.size(), static_cast<float>(1.5 / std::sqrt(inputs)));
      fill(layer.bias.data(), static_cast<Eigen::Index>(layer.bias.size()), .25f);
    }
    fill(p.scale.data(), static_cast<Eigen::Index>(p.scale.size()), .25f, 1.f);
    fill(p.shift.data(), static_cast<Eigen::Index>(p.shift.size()), .125f);
  }

 private:
  float next() {
    std::uint64_t z = ((seed_ << 32) + count_++) * 0x9E3779B97F4A7C15u + 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return static_cast<float>(static_cast<double>(z >> 40) / 8388608.0 - 1.0);
  }
  std::uint64_t seed_, count_ = 0;
};

}  // namespace

std::filesystem::path pack_folder() {
  const std::filesystem::path folder = fake::open_data() / "parity";
  if (std::filesystem::exists(folder)) return folder;
  WARN("skipped: no parity packs at " + folder.string());
  return {};
}

std::vector<std::string> step_cases(const std::string& model) {
  if (model == "hood")
    return {"hood_step0", "hood_step1", "hood_step2", "hood_step_nobody_nopin", "hood_step_training"};
  return {"ccraft_fold_init",  "ccraft_fold_nobody",   "ccraft_fold_step0",
          "ccraft_fold_step1", "ccraft_fold_training", "ccraft_two_step0"};
}

Architecture recorded_architecture(const std::string& model) {
  Architecture a = architecture_preset(model == "hood" ? "hood" : "contourcraft");
  a.width = 16;
  return a;
}

NetworkWeights formula_weights(const std::string& model) {
  const bool hood = model == "hood";
  const Architecture a = recorded_architecture(model);
  NetworkWeights weights = blank_weights(a);
  Formula formula(hood ? 1016 : 2016);
  formula.fill(weights.node_encoder);
  formula.fill(weights.decoder);
  for (Perceptron& encoder : weights.encoders) formula.fill(encoder);
  const std::vector<std::string> order =
      hood ? std::vector<std::string>{"world_edge", "mesh_edge", "coarse_edge0", "coarse_edge1"}
           : std::vector<std::string>{"body_edge", "repulsion_edge", "attraction_edge", "mesh_edge", "coarse_edge3"};
  for (std::size_t step = 0; step < a.steps.size(); ++step) {
    for (const std::string& key : order)
      for (std::size_t k = 0; k < a.steps[step].edge_keys.size(); ++k)
        if (a.steps[step].edge_keys[k] == key) formula.fill(weights.steps[step].edges[k]);
    formula.fill(weights.steps[step].node);
  }
  return weights;
}

Graph recorded_graph(const std::filesystem::path& path) {
  const Npz file(path);
  Graph graph;
  graph.cloth_nodes = static_cast<int>(file.numbers("cloth_pos").shape[0]);
  graph.nodes = rows_of(file, "node_features");
  for (const std::string name :
       {"mesh", "coarse0", "coarse1", "coarse2", "coarse3", "repulsion", "attraction", "world", "body"}) {
    if (!file.has(name + "_edge_index")) continue;
    if (name == "world" || name == "body") {
      graph.edge_sets.push_back(body_edges(file, name, graph.cloth_nodes));
      continue;
    }
    EdgeSet set;
    set.key = name.starts_with("coarse") ? "coarse_edge" + name.substr(6) : name + "_edge";
    set.senders = index_row(file, name + "_edge_index", 0);
    set.receivers = index_row(file, name + "_edge_index", 1);
    set.features = rows_of(file, name + "_features");
    graph.edge_sets.push_back(std::move(set));
  }
  return graph;
}

FeatureRows recorded_rows(const std::filesystem::path& path, const std::string& name) {
  return rows_of(Npz(path), name);
}

}  // namespace selvedge::recorded
