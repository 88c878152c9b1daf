#include "tests/learned/network_by_definition.hpp"

#include <cmath>

#include "learned/network/graph_plan.hpp"

namespace selvedge::by_definition {
namespace {

constexpr float norm_epsilon = 1e-5f;

void normalise_row(const Perceptron& p, std::vector<float>& row) {
  const auto columns = static_cast<float>(row.size());
  float mean = 0, variance = 0;
  for (const float x : row) mean += x;
  mean /= columns;
  for (const float x : row) variance += (x - mean) * (x - mean);
  const float factor = 1.f / std::sqrt(variance / columns + norm_epsilon);
  for (std::size_t k = 0; k < row.size(); ++k) row[k] = (row[k] - mean) * factor * p.scale[k] + p.shift[k];
}

std::vector<float> evaluate(const Perceptron& p, std::vector<float> row) {
  for (std::size_t layer = 0; layer < p.layers.size(); ++layer) {
    const AffineLayer& affine = p.layers[layer];
    std::vector<float> next = affine.bias;
    const float* weight = affine.weight.data();
    for (float& x : next)
      for (const float input : row) x += *weight++ * input;
    if (layer + 1 < p.layers.size())
      for (float& x : next) x = x < 0 ? 0 : x;  // NaN stays
    row = std::move(next);
  }
  if (!p.scale.empty()) normalise_row(p, row);
  return row;
}

void append(std::vector<float>& row, const FeatureRows& rows, int i) {
  row.insert(row.end(), rows.row(i).data(), rows.row(i).data() + rows.cols());
}

FeatureRows evaluate_rows(const Perceptron& p, const FeatureRows& inputs) {
  FeatureRows results(inputs.rows(), static_cast<Eigen::Index>(p.layers.back().bias.size()));
  for (int i = 0; i < inputs.rows(); ++i) {
    std::vector<float> row;
    append(row, inputs, i);
    row = evaluate(p, std::move(row));
    results.row(i) = Eigen::Map<const Eigen::RowVectorXf>(row.data(), results.cols());
  }
  return results;
}

// New values of the edges of one set, without residual. They are zero for edges that take no part.
FeatureRows update_edges(const Perceptron& p, const EdgeSet& set, const std::vector<char>& takes_part,
                         const FeatureRows& nodes, const FeatureRows& edges) {
  FeatureRows updated = FeatureRows::Zero(edges.rows(), edges.cols());
  for (int e = 0; e < edges.rows(); ++e) {
    if (!takes_part[e]) continue;
    std::vector<float> row;
    append(row, nodes, set.receivers[e]);
    append(row, nodes, set.senders[e]);
    append(row, edges, e);
    row = evaluate(p, std::move(row));
    updated.row(e) = Eigen::Map<const Eigen::RowVectorXf>(row.data(), edges.cols());
  }
  return updated;
}

std::vector<char> participants(const Graph& graph, const EdgeSet& set, const MessageStep& step) {
  std::vector<char> takes_part(set.senders.size(), true);
  for (const EdgeFilter& filter : step.filters) {
    if (filter.key != set.key) continue;
    const std::vector<char> passes = passes_filter(graph, set, filter);
    for (std::size_t e = 0; e < passes.size(); ++e) takes_part[e] = takes_part[e] && passes[e];
  }
  return takes_part;
}

void pass_messages(const MessageStep& step, const StepWeights& weights, const Graph& graph, FeatureRows& nodes,
                   std::vector<FeatureRows>& edges) {
  const Eigen::Index width = nodes.cols();
  FeatureRows inputs = FeatureRows::Zero(nodes.rows(), width * static_cast<Eigen::Index>(1 + step.edge_keys.size()));
  inputs.leftCols(width) = nodes;
  for (std::size_t k = 0; k < step.edge_keys.size(); ++k)
    for (std::size_t s = 0; s < graph.edge_sets.size(); ++s) {
      const EdgeSet& set = graph.edge_sets[s];
      if (set.key != step.edge_keys[k]) continue;
      const FeatureRows updated = update_edges(weights.edges[k], set, participants(graph, set, step), nodes, edges[s]);
      for (int e = 0; e < updated.rows(); ++e)
        inputs.row(set.receivers[e]).segment(width * static_cast<Eigen::Index>(1 + k), width) += updated.row(e);
      edges[s] += updated;
    }
  nodes += evaluate_rows(weights.node, inputs);
}

}  // namespace

FeatureRows infer(const Architecture& a, const NetworkWeights& weights, const Graph& graph, LatentTrace* trace) {
  check_weights(a, weights, "network");
  check_graph(a, graph);
  FeatureRows nodes = evaluate_rows(weights.node_encoder, graph.nodes);
  std::vector<FeatureRows> edges;
  for (const EdgeSet& set : graph.edge_sets)
    edges.push_back(evaluate_rows(weights.encoders[encoder_of(a, set.key)], set.features));
  if (trace) *trace = {{nodes}, edges, {}};
  for (std::size_t step = 0; step < a.steps.size(); ++step) {
    pass_messages(a.steps[step], weights.steps[step], graph, nodes, edges);
    if (trace) trace->nodes.push_back(nodes);
  }
  if (trace) trace->edges_last = edges;
  return evaluate_rows(weights.decoder, nodes.topRows(graph.cloth_nodes));
}

}  // namespace selvedge::by_definition
