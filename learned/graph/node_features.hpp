#pragma once

#include "learned/graph/body_pairs.hpp"
#include "learned/graph/feature_tables.hpp"
#include "learned/graph/seen_positions.hpp"

namespace selvedge {

// Fills types, levels and raw rows of the graph's nodes: the cloth's, then those of graph.body_vertices. Throws Error
// where the tables lack a row for a type or a level.
void fill_node_rows(const GraphScene&, const RestGraph&, const GraphState&, const SeenPositions&, const FeatureOptions&,
                    const FeatureTables&, Graph&);

// Fills the objective's columns and the flags of cloth nodes. p is the point of the pair's face that is nearest x now,
// and p' is the same point in the next pose. The body columns are x - p, x - p', the face's next normal, the signed
// distances of x from its plane now and of the guess from its next plane, and p' - p. They are zero without a pair. The
// guess columns are guess - x, and what is left at the guess of the solver's forces over the mass, times dt^2: the
// elastic ones (GraphState::elastic) and those of inertia with gravity and wind, x + velocity + dt^2 acceleration -
// guess. The length l of each of these two is compressed to log(1 + l / 1 mm), and they are zero at pinned vertices.
// The last of the guess columns are the motion of the skinned target in the frame, and the offset of x from it now.
void fill_objective_columns(const GraphScene&, const GraphState&, const SeenPositions&, const Points& guess,
                            const Points& inertial, const FeatureOptions&, const std::vector<BodyPair>&, Graph&);

}  // namespace selvedge
