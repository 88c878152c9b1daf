#include "learned/graph/unite_graphs.hpp"

#include <algorithm>

namespace selvedge {
namespace {

void append(const std::vector<int>& from, std::vector<int>& to) { to.insert(to.end(), from.begin(), from.end()); }

// Where the nodes of a graph are in the union.
struct NodePlaces {
  int cloth_nodes, first_cloth, first_obstacle;
  int of(int node) const { return node < cloth_nodes ? first_cloth + node : first_obstacle + node - cloth_nodes; }
};

std::vector<NodePlaces> node_places(std::span<const Graph* const> graphs) {
  std::vector<NodePlaces> places;
  int cloth = 0;
  for (const Graph* graph : graphs) {
    places.push_back({graph->cloth_nodes, cloth, 0});
    cloth += graph->cloth_nodes;
  }
  int next = cloth;
  for (std::size_t g = 0; g < graphs.size(); ++g) {
    places[g].first_obstacle = next;
    next += static_cast<int>(graphs[g]->nodes.rows()) - graphs[g]->cloth_nodes;
  }
  return places;
}

// Puts a value of each node, where the graphs have one, at its place in the union.
void place_values(std::span<const Graph* const> graphs, const std::vector<NodePlaces>& places, Eigen::Index nodes,
                  std::vector<int> Graph::*values, Graph& united) {
  (united.*values).clear();
  for (std::size_t g = 0; g < graphs.size(); ++g) {
    const std::vector<int>& own = graphs[g]->*values;
    if (own.empty()) continue;
    (united.*values).resize(static_cast<std::size_t>(nodes));
    for (std::size_t i = 0; i < own.size(); ++i)
      (united.*values)[static_cast<std::size_t>(places[g].of(static_cast<int>(i)))] = own[i];
  }
}

EdgeSet& set_with_key(const std::string& key, Graph& graph) {
  auto at = std::ranges::find(graph.edge_sets, key, &EdgeSet::key);
  if (at == graph.edge_sets.end()) at = graph.edge_sets.insert(at, EdgeSet{key, {}, {}, {}, {}});
  return *at;
}

void append_edges(const EdgeSet& from, const NodePlaces& places, EdgeSet& to) {
  for (const int sender : from.senders) to.senders.push_back(places.of(sender));
  for (const int receiver : from.receivers) to.receivers.push_back(places.of(receiver));
  append(from.labels, to.labels);
  const Eigen::Index before = to.features.rows();
  to.features.conservativeResize(before + from.features.rows(), from.features.cols());
  to.features.bottomRows(from.features.rows()) = from.features;
}

}  // namespace

void unite_graphs(std::span<const Graph* const> graphs, Graph& united) {
  const std::vector<NodePlaces> places = node_places(graphs);
  united = {};
  Eigen::Index nodes = 0;
  for (const Graph* graph : graphs) {
    united.cloth_nodes += graph->cloth_nodes;
    append(graph->body_vertices, united.body_vertices);
    nodes += graph->nodes.rows();
  }
  united.nodes.resize(nodes, graphs.front()->nodes.cols());
  for (std::size_t g = 0; g < graphs.size(); ++g) {
    const Graph& graph = *graphs[g];
    const Eigen::Index others = graph.nodes.rows() - graph.cloth_nodes;
    united.nodes.middleRows(places[g].first_cloth, graph.cloth_nodes) = graph.nodes.topRows(graph.cloth_nodes);
    united.nodes.middleRows(places[g].first_obstacle, others) = graph.nodes.bottomRows(others);
    for (const EdgeSet& set : graph.edge_sets) append_edges(set, places[g], set_with_key(set.key, united));
  }
  place_values(graphs, places, nodes, &Graph::node_types, united);
  place_values(graphs, places, nodes, &Graph::node_levels, united);
}

}  // namespace selvedge
