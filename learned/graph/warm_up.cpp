#include "learned/graph/warm_up.hpp"

#include <cmath>

namespace selvedge {
namespace {

constexpr double least_variation = 1e-4;  // least deviation that is used, as a fraction of a column's root mean square

void freeze(const DoubleAccumulators& sums, Statistics& statistics) {
  if (sums.rows <= 0) return;
  statistics = statistics_of(sums);
  for (std::size_t k = 0; k < statistics.mean.size(); ++k) {
    const double size = std::sqrt(sums.sum_squared[k] / sums.rows);
    if (static_cast<double>(statistics.deviation[k]) <= least_variation * size || size == 0)
      statistics.deviation[k] = 1.f;
  }
}

}  // namespace

void gather(const FeatureOptions& options, const Graph& raw, const FeatureRows& accelerations,
            FeatureSums<double>& sums) {
  for (const EdgeSet& set : raw.edge_sets) accumulate(sums_for(set.key, options, sums), set.features);
  accumulate(sums.node, raw.nodes);
  accumulate(sums.output, accelerations);
}

void freeze_statistics(const FeatureSums<double>& sums, FeatureTables& tables) {
  visit_statistics([](const char*, const DoubleAccumulators& of_set, Statistics& made) { freeze(of_set, made); }, sums,
                   tables);
}

}  // namespace selvedge
