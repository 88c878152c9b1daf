#pragma once

#include <random>

#include "learned/network/architecture.hpp"

namespace selvedge::in_tests {

// Edges of every kind of the network between random nodes. One node receives a tenth of them, so that its sum spans
// many tiles. Types, levels and labels are rows of the architecture's embeddings.
inline Graph random_graph(const Architecture& a, int cloth, int others, int edges, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto fill = [&](Eigen::Index rows, Eigen::Index columns) {
    return FeatureRows(FeatureRows::NullaryExpr(rows, columns, [&] { return uniform(random); }));
  };
  const auto values = [&](int count, int rows) {
    std::vector<int> list;
    for (int i = 0; i < count && rows > 0; ++i)
      list.push_back(static_cast<int>(random() % static_cast<unsigned>(rows)));
    return list;
  };
  Graph graph;
  graph.cloth_nodes = cloth;
  graph.nodes = fill(cloth + others, a.node_inputs);
  const int nodes = cloth + others;
  graph.node_types = values(nodes, a.node_type.rows);
  graph.node_levels = values(nodes, a.vertex_level.rows);
  for (const EdgeKind& kind : a.edge_kinds) {
    EdgeSet set;
    set.key = kind.key;
    const int few = kind.key.starts_with("coarse") ? std::max(1, cloth / 3) : nodes;
    for (int e = 0; e < edges; ++e) {
      set.senders.push_back(static_cast<int>(random() % static_cast<unsigned>(few)));
      set.receivers.push_back(e % 10 == 0 ? few - 1 : static_cast<int>(random() % static_cast<unsigned>(few)));
    }
    set.features = fill(edges, a.encoders[static_cast<std::size_t>(kind.encoder)].inputs);
    if (kind.key == "repulsion_edge" || kind.key == "attraction_edge") set.labels = values(edges, a.edge_type.rows);
    graph.edge_sets.push_back(std::move(set));
  }
  return graph;
}

inline Architecture with_size(const std::string& preset, int width, int steps) {
  Architecture a = architecture_preset(preset);
  a.width = width;
  a.steps.resize(static_cast<std::size_t>(steps));
  return a;
}

}  // namespace selvedge::in_tests
