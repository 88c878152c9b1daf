#pragma once

#include <span>
#include <string>
#include <vector>

#include "learned/graph/coarse_levels.hpp"
#include "learned/graph/feature_options.hpp"
#include "learned/graph/graph_state.hpp"

namespace selvedge {

// Mesh or coarse edges both ways, the second half the reverse of the first.
struct RestEdges {
  std::string key;
  std::vector<int> senders, receivers;
  FeatureRows rest;       // columns of the rest shape
  FeatureRows materials;  // E x 3: mean of both ends
};

// The constant part of a scene's graph. Make it again when the scene's cloth, rest positions or materials change.
struct RestGraph {
  std::vector<RestEdges> sets;  // mesh_edge, then coarse_sets
  CoarseLevels coarse;
  std::vector<int> vertex_levels;  // rows of the embedding: at most highest_level
  std::vector<float> mass;         // the mass column of each cloth vertex
  std::vector<int> pinned;         // cloth vertices, ascending
};

// Throws Error for a scene whose parts do not fit together or whose numbers are not finite. Centres are those of
// make_coarse_levels. Mesh edges are sorted by their larger, then their smaller vertex. Springs are mesh edges with
// their own rest length, and coarse levels ignore them.
RestGraph make_rest_graph(const GraphScene&, const FeatureOptions&, std::span<const int> centres = {});

// Fills in the columns of edges whose senders and receivers are given.
void fill_rest_columns(const GraphScene&, const FeatureOptions&, RestEdges&);

}  // namespace selvedge
