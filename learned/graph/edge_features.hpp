#pragma once

#include "learned/graph/body_pairs.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/graph/feature_tables.hpp"
#include "learned/graph/seen_positions.hpp"

namespace selvedge {

// Edge sets with raw rows; relative vectors are sender - receiver. A set's memory is used again.

// Mesh or coarse edges at seen.mesh; strains at seen.mesh and at the guess (guess_of), where the options ask for them.
void fill_mesh_edges(const RestEdges&, const GraphState&, const SeenPositions&, const Points& guess,
                     const FeatureOptions&, EdgeSet&);

// Edges from cloth to body, then the same from body to cloth: relative vectors negated, all else alike. Body nodes
// stand behind the cloth in the order of `body_vertices`, which has every vertex of the pairs, ascending.
void fill_body_edges(const std::vector<BodyPair>&, const std::vector<int>& body_vertices, const GraphState&,
                     const SeenPositions&, const FeatureOptions&, EdgeSet&);

// Edges from the vertex of each pair to the nearest vertex of its face, one way.
void fill_cloth_edges(const std::vector<ClothPair>&, const GraphScene&, const GraphState&, const SeenPositions&,
                      const FeatureOptions&, const FeatureTables&, EdgeSet&);

}  // namespace selvedge
