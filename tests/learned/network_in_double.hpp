#pragma once

#include <cmath>
#include <map>
#include <string>

#include "learned/graph/make_graph.hpp"
#include "learned/network/graph_plan.hpp"
#include "learned/network/weights.hpp"

// The network in double, matrix by matrix, from weights by name. Tests compare derivatives with it.
namespace selvedge::in_double {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Arrays = std::map<std::string, Matrix>;

inline Arrays arrays_of(const Architecture& a, NetworkWeights weights) {
  Arrays arrays;
  for (const WeightArray& array : weight_arrays(a, weights))
    arrays[array.name] = Eigen::Map<const FeatureRows>(array.data, array.rows, array.columns).cast<double>();
  return arrays;
}

inline Matrix perceptron(const Arrays& w, const std::string& name, Matrix x) {
  for (int layer = 0; w.contains(name + "/layer" + std::to_string(layer) + "/weight"); ++layer) {
    const std::string at = name + "/layer" + std::to_string(layer);
    if (layer > 0) x = x.cwiseMax(0).eval();
    x = ((x * w.at(at + "/weight").transpose()).rowwise() + w.at(at + "/bias").col(0).transpose()).eval();
  }
  if (!w.contains(name + "/norm/scale")) return x;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double mean = x.row(i).mean();
    x.row(i).array() -= mean;
    const double variance = x.row(i).squaredNorm() / static_cast<double>(x.cols());
    x.row(i) = (x.row(i).array() / std::sqrt(variance + 1e-5) * w.at(name + "/norm/scale").col(0).transpose().array() +
                w.at(name + "/norm/shift").col(0).transpose().array())
                   .eval();
  }
  return x;
}

// Features with the embeddings of the arrays in their columns.
inline void embed(const Arrays& w, const std::string& table, const std::vector<int>& values, int first,
                  const Statistics& statistics, Matrix& rows) {
  const auto found = w.find("embeddings/" + table);
  if (found == w.end()) return;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (Eigen::Index k = 0; k < found->second.cols(); ++k) {
      const auto at = static_cast<std::size_t>(first + k);
      rows(static_cast<Eigen::Index>(i), first + k) =
          (found->second(values[i], k) - static_cast<double>(statistics.mean[at])) /
          static_cast<double>(statistics.deviation[at]);
    }
}

inline Matrix output(const Architecture& a, const Arrays& w, const FeatureTables& tables, const Graph& graph) {
  const EmbeddingColumns columns = embedding_columns(a.features);
  Matrix nodes = graph.nodes.cast<double>();
  embed(w, "node_type", graph.node_types, columns.type, tables.node, nodes);
  embed(w, "vertex_level", graph.node_levels, columns.level, tables.node, nodes);
  nodes = perceptron(w, "node_encoder", nodes);
  std::map<std::string, Matrix> edges;
  for (const EdgeSet& set : graph.edge_sets) {
    Matrix features = set.features.cast<double>();
    if (!set.labels.empty())
      embed(w, "edge_type", set.labels, columns.label, statistics_for(set.key, a.features, tables), features);
    const int encoder = a.edge_kinds[static_cast<std::size_t>(edge_kind(a, set.key))].encoder;
    edges[set.key] = perceptron(w, "encoders/" + a.encoders[static_cast<std::size_t>(encoder)].name, features);
  }
  const Eigen::Index width = a.width;
  for (std::size_t s = 0; s < a.steps.size(); ++s) {
    char step[40];
    std::snprintf(step, sizeof step, "steps/%03zu", s);
    Matrix inputs = Matrix::Zero(nodes.rows(), width * static_cast<Eigen::Index>(1 + a.steps[s].edge_keys.size()));
    inputs.leftCols(width) = nodes;
    Eigen::Index block = width;
    for (const std::string& key : a.steps[s].edge_keys) {
      for (const EdgeSet& set : graph.edge_sets) {
        if (set.key != key) continue;
        std::vector<char> kept(set.senders.size(), true);
        for (const EdgeFilter& filter : a.steps[s].filters) {
          if (filter.key != key) continue;
          const std::vector<char> passes = passes_filter(graph, set, filter);
          for (std::size_t e = 0; e < kept.size(); ++e) kept[e] = kept[e] && passes[e];
        }
        for (std::size_t e = 0; e < kept.size(); ++e) {
          if (!kept[e]) continue;
          const auto at = static_cast<Eigen::Index>(e);
          Matrix row(1, 3 * width);
          row << nodes.row(set.receivers[e]), nodes.row(set.senders[e]), edges[key].row(at);
          row = perceptron(w, std::string(step) + "/edges/" + key, row);
          inputs.row(set.receivers[e]).segment(block, width) += row;
          edges[key].row(at) += row;
        }
      }
      block += width;
    }
    nodes += perceptron(w, std::string(step) + "/node", inputs);
  }
  return perceptron(w, "decoder", nodes.topRows(graph.cloth_nodes));
}

}  // namespace selvedge::in_double
