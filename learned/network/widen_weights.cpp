#include "learned/network/widen_weights.hpp"

#include <algorithm>

#include "collision/geometry/error.hpp"

namespace selvedge {
namespace {

void refuse_widening(bool wrong, const std::string& what) {
  if (wrong)
    throw Error("the network is no wider form of the other: " + what, "start of a training",
                "start from weights of the same steps, widths and features");
}

// Inserts zero columns [first, first + count) into a first layer.
void insert_zero_inputs(Perceptron& p, Eigen::Index first, Eigen::Index count) {
  FeatureRows& weight = p.layers.front().weight;
  FeatureRows wide = FeatureRows::Zero(weight.rows(), weight.cols() + count);
  wide.leftCols(first) = weight.leftCols(first);
  wide.rightCols(weight.cols() - first) = weight.rightCols(weight.cols() - first);
  weight = std::move(wide);
}

void insert_zero_statistics(Statistics& s, std::size_t first, std::size_t count) {
  s.mean.insert(s.mean.begin() + static_cast<std::ptrdiff_t>(first), count, 0.f);
  s.deviation.insert(s.deviation.begin() + static_cast<std::ptrdiff_t>(first), count, 1.f);
}

// `wide` begins as random weights of the step `to`. Kinds that `to` lacks must be among `unseen`.
void widen_step(const MessageStep& from, const StepWeights& weights, const MessageStep& to, int width,
                const std::vector<std::string>& unseen, StepWeights& wide) {
  const FeatureRows old = weights.node.layers.front().weight;
  wide.node = weights.node;
  FeatureRows& weight = wide.node.layers.front().weight;
  weight = FeatureRows::Zero(old.rows(), static_cast<Eigen::Index>(1 + to.edge_keys.size()) * width);
  weight.leftCols(width) = old.leftCols(width);
  for (std::size_t k = 0; k < to.edge_keys.size(); ++k) {
    const auto found = std::ranges::find(from.edge_keys, to.edge_keys[k]);
    if (found == from.edge_keys.end()) continue;
    const std::ptrdiff_t at = found - from.edge_keys.begin();
    weight.middleCols(static_cast<Eigen::Index>(1 + k) * width, width) = old.middleCols((1 + at) * width, width);
    wide.edges[k] = weights.edges[static_cast<std::size_t>(at)];
  }
  for (const std::string& key : from.edge_keys)
    refuse_widening(
        std::ranges::find(to.edge_keys, key) == to.edge_keys.end() && std::ranges::find(unseen, key) == unseen.end(),
        "a step lacks a kind of edges");
}

// The cloth-cloth edges that a network has and was never trained with.
std::vector<std::string> unseen_edges(const Architecture& from, const NetworkWeights& weights) {
  if (!from.features.cloth_edges || from.features.body_key == "world_edge" || !are_blank(weights.tables.world_edge))
    return {};
  return {"attraction_edge", "repulsion_edge"};
}

}  // namespace

NetworkWeights widen_weights(const Architecture& from, const NetworkWeights& weights, const Architecture& to,
                             std::uint64_t seed) {
  refuse_widening(from.width != to.width || from.hidden_layers != to.hidden_layers || from.outputs != to.outputs ||
                      from.steps.size() != to.steps.size(),
                  "other sizes");
  const int more = to.node_inputs - from.node_inputs;
  const bool accelerated = to.features.acceleration_inputs && !from.features.acceleration_inputs;
  refuse_widening(more != (accelerated ? 3 : 0), "other node features");
  NetworkWeights wide = random_weights(to, seed);
  const FeatureTables fresh = wide.tables;
  wide.node_encoder = weights.node_encoder;
  wide.decoder = weights.decoder;
  wide.tables = weights.tables;
  wide.tables.space_edge = from.statistics.space_edge > 0 ? weights.tables.space_edge : fresh.space_edge;
  if (accelerated) {
    insert_zero_inputs(wide.node_encoder, from.statistics.node, 3);
    insert_zero_statistics(wide.tables.node, wide.tables.node.mean.size(), 3);
  }
  const std::vector<std::string> unseen = unseen_edges(from, weights);
  if (!to.features.cloth_edges && !unseen.empty()) wide.tables.world_edge = fresh.world_edge;
  for (std::size_t e = 0; e < from.encoders.size(); ++e) {
    const auto same = std::ranges::find(to.encoders, from.encoders[e].name, &EdgeEncoder::name);
    if (same == to.encoders.end() && std::ranges::find(unseen, from.encoders[e].name + "_edge") != unseen.end())
      continue;
    refuse_widening(same == to.encoders.end() || same->inputs != from.encoders[e].inputs, "an encoder is missing");
    wide.encoders[static_cast<std::size_t>(same - to.encoders.begin())] = weights.encoders[e];
  }
  for (std::size_t i = 0; i < to.steps.size(); ++i)
    widen_step(from.steps[i], weights.steps[i], to.steps[i], to.width, unseen, wide.steps[i]);
  check_weights(to, wide, "start of a training");
  return wide;
}

}  // namespace selvedge
