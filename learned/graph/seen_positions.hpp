#pragma once

#include "learned/graph/feature_options.hpp"
#include "learned/graph/rest_graph.hpp"

namespace selvedge {

// Where the model sees the cloth, pinned vertices being moved as the options say.
struct SeenPositions {
  Points x, previous;  // for normals, body and cloth edges
  Points mesh;         // for mesh and coarse edges, and the future of pinned vertices
};

// V x 3 each [m].
SeenPositions seen_positions(const RestGraph&, const GraphState&, const FeatureOptions&);

// What the cloth would do without forces, and where the first pass of a frame begins: x + velocity (the state's, or x -
// previous as the options say), pinned vertices at their targets.
Points inertial_guess(const RestGraph&, const GraphState&, const SeenPositions&, const FeatureOptions&);
// state.guess, or the inertial guess where that is empty.
Points guess_of(const RestGraph&, const GraphState&, const SeenPositions&, const FeatureOptions&);

// Moves pinned vertices to their targets: previous <- x, x <- target.
void move_pinned(const RestGraph&, const Points& target, Points& x, Points& previous);

}  // namespace selvedge
