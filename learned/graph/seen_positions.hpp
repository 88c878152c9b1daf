#pragma once

#include "learned/graph/feature_options.hpp"
#include "learned/graph/rest_graph.hpp"

namespace selvedge {

// Where the model sees the cloth, pinned vertices being moved as the options say.
struct SeenPositions {
  Points x, previous;  // for normals, body and cloth edges
  Points mesh;         // for mesh and coarse edges, and the future of pinned vertices
};

SeenPositions seen_positions(const RestGraph&, const GraphState&, const FeatureOptions&);

// Moves pinned vertices to their targets: previous <- x, x <- target.
void move_pinned(const RestGraph&, const Points& target, Points& x, Points& previous);

}  // namespace selvedge
