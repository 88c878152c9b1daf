#pragma once

#include "learned/graph/feature_tables.hpp"
#include "learned/graph/seen_positions.hpp"

namespace selvedge {

// Fills types, levels and raw rows of the graph's nodes: the cloth's, then those of graph.body_vertices. Throws Error
// where the tables lack a row for a type or a level.
void fill_node_rows(const GraphScene&, const RestGraph&, const GraphState&, const SeenPositions&, const FeatureOptions&,
                    const FeatureTables&, Graph&);

}  // namespace selvedge
