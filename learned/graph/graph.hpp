#pragma once

#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// One row a node or an edge, one column a feature.
using FeatureRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Directed edges of one kind. Edge e leads from node senders[e] to node receivers[e]; row e of `features` is what the
// edge encoder sees. In sets that lead both ways the second half is the reverse of the first.
struct EdgeSet {
  std::string key;  // mesh_edge, coarse_edge0.., world_edge, body_edge, repulsion_edge, attraction_edge
  std::vector<int> senders, receivers;
  FeatureRows features;
  std::vector<int> labels;  // rows of the edge type embedding; empty for sets without one
};

// What a network sees of one state. The nodes are all cloth vertices, then those obstacle vertices that have an edge.
struct Graph {
  int cloth_nodes = 0;
  std::vector<int> body_vertices;            // of the nodes behind the cloth, ascending
  std::vector<int> node_types, node_levels;  // rows of the embeddings; one a node
  FeatureRows nodes;
  std::vector<EdgeSet> edge_sets;
};

}  // namespace selvedge
