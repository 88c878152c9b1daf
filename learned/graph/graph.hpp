#pragma once

#include <string>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// One row per node or edge, one column per feature.
using FeatureRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Directed edges of one kind. Edge e leads from node senders[e] to node receivers[e], and row e of `features` is the
// input of the edge encoder. In sets that lead both ways the second half is the reverse of the first.
struct EdgeSet {
  std::string key;  // one of edge_set_keys (feature_options.hpp)
  std::vector<int> senders, receivers;
  FeatureRows features;
  std::vector<int> labels;  // rows of the edge type embedding; empty for sets without one
};

// A state as a network sees it. The nodes are all cloth vertices, then the obstacle vertices that have an edge.
struct Graph {
  int cloth_nodes = 0;
  std::vector<int> body_vertices;            // body vertices of the nodes after the cloth, ascending
  std::vector<int> node_types, node_levels;  // rows of the embeddings, one per node
  FeatureRows nodes;
  std::vector<EdgeSet> edge_sets;
};

}  // namespace selvedge
