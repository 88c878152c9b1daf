#pragma once

#include "learned/graph/feature_options.hpp"
#include "learned/graph/rest_graph.hpp"

namespace selvedge {

// The cloth as the model sees it, with pinned vertices moved as the options say. V x 3 each [m].
struct SeenPositions {
  Points x, previous;  // for normals, body edges and cloth edges
  Points mesh;         // for mesh and coarse edges, and the future of pinned vertices
};

SeenPositions seen_positions(const RestGraph&, const GraphState&, const FeatureOptions&);

// The cloth's next positions without forces, where the first pass of a frame begins: x + velocity (the state's, or x -
// previous as the options say), pinned vertices at their targets.
Points inertial_guess(const RestGraph&, const GraphState&, const SeenPositions&, const FeatureOptions&);
// state.guess, or the inertial guess if that is empty.
Points guess_of(const RestGraph&, const GraphState&, const SeenPositions&, const FeatureOptions&);

}  // namespace selvedge
