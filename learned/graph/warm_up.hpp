#pragma once

#include "learned/graph/make_graph.hpp"

namespace selvedge {

// Statistics of features for training of one's own: summed up over states of a warm-up, noise included, then frozen.
// Sums start from empty_sums<double>.

// Adds a raw graph (make_raw_graph) and the accelerations that its output is to be like (target_accelerations).
// Columns of learned embeddings are summed up like others.
void gather(const FeatureOptions&, const Graph& raw, const FeatureRows& accelerations, FeatureSums<double>&);

// Sets statistics from the sums. Sets of which no row was seen keep what they have. A column that hardly varied, by
// 1e-4 of its root mean square or less, gets deviation 1, so that neither its rounding nor the gradient of an embedding
// is blown up (parity README, 15).
void freeze_statistics(const FeatureSums<double>&, FeatureTables&);

// Writes the embeddings of the tables into a normalised graph that was made with others: they change with every step of
// training, while graphs are made ahead.
void embed_again(const FeatureOptions&, const FeatureTables&, Graph&);

}  // namespace selvedge
