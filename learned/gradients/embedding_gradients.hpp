#pragma once

#include "learned/network/latent_rows.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Add the derivatives of the embedding tables. Row by row, `d_first` has the derivatives by the results of an encoder's
// first layer before max(0, .), and `first_layer` has its weights. A feature is (table entry - mean) / deviation.
// Nothing is added where the architecture has no table or the graph has no values.
void add_node_gradients(const Architecture&, const Graph&, const FeatureRows& first_layer, const FeatureTables&,
                        const LatentRows& d_first, FeatureTables& gradients);
// Row i of `d_first` belongs to edge order[i].
void add_label_gradients(const Architecture&, const EdgeSet&, const std::vector<int>& order,
                         const FeatureRows& first_layer, const FeatureTables&, const LatentRows& d_first,
                         FeatureTables& gradients);

}  // namespace selvedge
