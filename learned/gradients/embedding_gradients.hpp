#pragma once

#include "learned/network/latent_rows.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Derivatives of the embedding tables. `d_first` has, row by row, those by the results of an encoder's first layer
// before max(0, .), and `first_layer` is its weights. A table's entry reaches a feature as (entry - mean) / deviation.
// Nothing happens where the architecture has no table, or the graph no values.
void add_node_gradients(const Architecture&, const Graph&, const FeatureRows& first_layer, const FeatureTables&,
                        const LatentRows& d_first, FeatureTables& gradients);
// Row i is edge order[i].
void add_label_gradients(const Architecture&, const EdgeSet&, const std::vector<int>& order,
                         const FeatureRows& first_layer, const FeatureTables&, const LatentRows& d_first,
                         FeatureTables& gradients);

}  // namespace selvedge
