#include <algorithm>

#include "learned/network/engine_kernels.hpp"
#include "learned/network/graph_plan.hpp"

namespace selvedge {
namespace {

int tile_padded(std::size_t rows) { return (static_cast<int>(rows) + tile_rows - 1) / tile_rows * tile_rows; }

}  // namespace

double count_operations(const Architecture& a, const Graph& graph) {
  check_graph(a, graph);
  const double width = a.width, hidden = a.hidden_layers - 1;
  const auto perceptron = [&](double inputs, double outputs) {
    return inputs * width + hidden * width * width + width * outputs;
  };
  const GraphPlan plan = plan_graph(a, graph, tile_rows);
  double products = static_cast<double>(graph.nodes.rows()) * perceptron(a.node_inputs, width) +
                    graph.cloth_nodes * perceptron(width, a.outputs);
  for (std::size_t s = 0; s < graph.edge_sets.size(); ++s) {
    const EdgeSet& set = graph.edge_sets[s];
    if (is_used(plan, s))
      products +=
          static_cast<double>(set.senders.size()) * perceptron(a.encoders[encoder_of(a, set.key)].inputs, width);
  }
  for (const std::vector<int>& step : plan.steps) {
    double blocks = static_cast<double>(graph.nodes.rows());
    for (const int index : step) {
      if (index < 0) continue;
      const EdgeSelection& selection = plan.selections[index];
      products += width * width * static_cast<double>(selection.receivers.size() + selection.senders.size()) +
                  static_cast<double>(selection.edge.size()) * perceptron(width, width);
      blocks += static_cast<double>(selection.receivers.size());
    }
    products += blocks * width * width + static_cast<double>(graph.nodes.rows()) * perceptron(0, width);
  }
  return 2 * products;
}

double count_bytes(const Architecture& a, const Graph& graph) {
  check_graph(a, graph);
  const GraphPlan plan = plan_graph(a, graph, tile_rows);
  double rows = tile_padded(static_cast<std::size_t>(graph.nodes.rows()));
  for (std::size_t s = 0; s < graph.edge_sets.size(); ++s)
    if (is_used(plan, s)) rows += tile_padded(graph.edge_sets[s].senders.size());
  int receivers = 0, senders = 0;
  for (const EdgeSelection& selection : plan.selections) {
    receivers = std::max(receivers, tile_padded(selection.receivers.size()));
    senders = std::max(senders, tile_padded(selection.senders.size()));
  }
  std::vector<int> sums;  // one per key of a step: the most over all steps
  for (const std::vector<int>& step : plan.steps)
    for (std::size_t k = 0; k < step.size(); ++k) {
      if (sums.size() <= k) sums.push_back(0);
      if (step[k] >= 0) sums[k] = std::max(sums[k], tile_padded(plan.selections[step[k]].receivers.size()));
    }
  for (const int one : sums) rows += one;
  return (rows + receivers + senders) * padded(a.width) * static_cast<double>(sizeof(float));
}

}  // namespace selvedge
