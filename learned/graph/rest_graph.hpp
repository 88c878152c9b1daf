#pragma once

#include <span>
#include <string>
#include <vector>

#include "learned/graph/coarse_levels.hpp"
#include "learned/graph/feature_options.hpp"
#include "learned/graph/graph_state.hpp"

namespace selvedge {

// A set of mesh or coarse edges: both ways, the second half the reverse of the first.
struct RestEdges {
  std::string key;
  std::vector<int> senders, receivers;
  FeatureRows rest;       // columns of the rest shape
  FeatureRows materials;  // E x 3: mean of both ends
};

// What of a scene's graph stays the same between frames. Made once; to be made anew where the scene's cloth, rest
// positions or materials change.
struct RestGraph {
  std::vector<RestEdges> sets;  // mesh_edge, then coarse_sets
  CoarseLevels coarse;
  std::vector<int> vertex_levels;  // as the embedding knows them: at most highest_level
  std::vector<float> mass;         // the mass column of each cloth vertex
  std::vector<int> pinned;         // cloth vertices, ascending
};

// Throws Error for a scene whose parts do not fit together or whose numbers are not finite. Centres: see
// make_coarse_levels. Mesh edges are sorted by their larger, then their smaller vertex. Springs are mesh edges too, as
// long at rest as they say; coarse levels know nothing of them.
RestGraph make_rest_graph(const GraphScene&, const FeatureOptions&, std::span<const int> centres = {});

// Fills in the columns of edges whose senders and receivers are given.
void fill_rest_columns(const GraphScene&, const FeatureOptions&, RestEdges&);

}  // namespace selvedge
