#pragma once

#include <array>

#include "tests/learned/parity_pack.hpp"

// Matches our rows with theirs.
namespace selvedge::parity {

using Pairs = std::vector<std::pair<int, int>>;
using Triples = std::vector<std::array<int, 3>>;

// The key of a directed edge between a cloth and a body vertex: the cloth's own number, the body's own number, and 0
// from cloth to body or 1 back.
inline Triples body_edge_keys(const Graph& graph, const EdgeSet& set) {
  Triples keys;
  for (std::size_t e = 0; e < set.senders.size(); ++e) {
    const bool back = set.senders[e] >= graph.cloth_nodes;
    const int cloth = back ? set.receivers[e] : set.senders[e];
    const int node = (back ? set.senders[e] : set.receivers[e]) - graph.cloth_nodes;
    keys.push_back({cloth, graph.body_vertices[static_cast<std::size_t>(node)], back ? 1 : 0});
  }
  return keys;
}

inline Triples their_body_edges(const Case& c) {
  Triples keys;
  const std::string name = c.options.body_key + "_index";
  if (!c.npz.has(name)) return keys;
  for (const int back : {0, 1})
    for (const auto& [cloth, body] : index_pairs(c.npz, name)) keys.push_back({cloth, body, back});
  return keys;
}

inline Triples pair_keys(const std::vector<ClothPair>& pairs) {
  Triples keys;
  for (const ClothPair& pair : pairs) keys.push_back({pair.vertex, pair.face, pair.label});
  return keys;
}

// kind: repulsion or attraction
inline Triples their_cloth_pairs(const Case& c, const std::string& kind) {
  const std::vector<int> from = integers(c.npz, kind + "_nodes_from"), to = integers(c.npz, kind + "_faces_to"),
                         labels = integers(c.npz, kind + "_labels");
  Triples keys;
  for (std::size_t i = 0; i < from.size(); ++i) keys.push_back({from[i], to[i], labels[i]});
  return keys;
}

// The rows of one of our edge sets, raw or normalised, in the order of the file.
inline FeatureRows their_order(const Case& c, const Graph& graph, const GraphReport& report, const std::string& key) {
  const EdgeSet& set = edge_set(graph, key);
  if (key == c.options.body_key) return in_their_order(body_edge_keys(graph, set), set.features, their_body_edges(c));
  if (key == "repulsion_edge")
    return in_their_order(pair_keys(report.cloth_pairs.repulsion), set.features, their_cloth_pairs(c, "repulsion"));
  if (key == "attraction_edge")
    return in_their_order(pair_keys(report.cloth_pairs.attraction), set.features, their_cloth_pairs(c, "attraction"));
  const std::string name = key == "mesh_edge" ? "mesh" : "coarse" + key.substr(std::string("coarse_edge").size());
  return in_their_order(directed(set), set.features, index_pairs(c.npz, name + "_edge_index"));
}

// The name of the set in the files: mesh, coarse0.., world, body, repulsion, attraction.
inline std::string file_name(const std::string& key) {
  if (key.starts_with("coarse_edge")) return "coarse" + key.substr(11);
  return key.substr(0, key.find("_edge"));
}

}  // namespace selvedge::parity
