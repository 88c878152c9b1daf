#pragma once

#include "learned/graph/body_pairs.hpp"
#include "learned/graph/cloth_pairs.hpp"
#include "learned/graph/feature_tables.hpp"
#include "learned/graph/seen_positions.hpp"

namespace selvedge {

// These fill edge sets with raw rows and use their memory again. Relative vectors are sender - receiver.

// Mesh or coarse edges at seen.mesh. Strains, where asked for, are at seen.mesh and at the guess (guess_of).
void fill_mesh_edges(const RestEdges&, const GraphState&, const SeenPositions&, const Points& guess,
                     const FeatureOptions&, EdgeSet&);

// Edges from cloth to body, then the same edges from body to cloth with negated relative vectors. Body nodes follow the
// cloth in the order of `body_vertices`, which has every body vertex of the pairs, ascending.
void fill_body_edges(const std::vector<BodyPair>&, const std::vector<int>& body_vertices, const GraphState&,
                     const SeenPositions&, const FeatureOptions&, EdgeSet&);

// One-way edges from the vertex of each pair to the nearest vertex of its face.
void fill_cloth_edges(const std::vector<ClothPair>&, const GraphScene&, const GraphState&, const SeenPositions&,
                      const FeatureOptions&, const FeatureTables&, EdgeSet&);

}  // namespace selvedge
