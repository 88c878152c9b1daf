#pragma once

#include "learned/graph/make_graph.hpp"

namespace selvedge {

// Feature statistics for own training: summed over the states of a warm-up, noise included, then frozen. Sums start
// from empty_sums.

// Adds a raw graph (make_raw_graph) and the accelerations that its output is trained for (target_accelerations).
// Columns of learned embeddings are summed too.
void gather(const FeatureOptions&, const Graph& raw, const FeatureRows& accelerations, FeatureSums<double>&);

// Sets statistics from the sums. Sets without rows keep theirs. A column that varied by 1e-4 of its root mean square or
// less gets deviation 1, so that its rounding and the gradient of an embedding stay small (parity README, 15).
void freeze_statistics(const FeatureSums<double>&, FeatureTables&);

}  // namespace selvedge
