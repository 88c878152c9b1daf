#include "learned/graph/warm_up.hpp"

#include <cmath>

#include "collision/geometry/error.hpp"
#include "learned/graph/embedding.hpp"

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

// Writes the columns of a table into rows that were normalised with other values.
void embed_columns(const FeatureRows& table, const std::vector<int>& values, int first, int columns,
                   const Statistics& statistics, FeatureRows& rows) {
  if (columns == 0 || table.rows() == 0) return;
  FeatureRows normal = table;
  for (Eigen::Index k = 0; k < normal.cols(); ++k) {
    const auto at = static_cast<std::size_t>(first + k);
    if (at >= statistics.mean.size())
      throw Error("statistics have too few columns", "weights of a learned stepper",
                  "use weights with their own architecture");
    normal.col(k) = (normal.col(k).array() - statistics.mean[at]) / statistics.deviation[at];
  }
  embed(normal, values, first, columns, rows);
}

}  // namespace

void gather(const FeatureOptions& options, const Graph& raw, const FeatureRows& accelerations,
            FeatureSums<double>& sums) {
  for (const EdgeSet& set : raw.edge_sets) accumulate(sums_for(set.key, options, sums), set.features);
  accumulate(sums.node, raw.nodes);
  accumulate(sums.output, accelerations);
}

void freeze_statistics(const FeatureSums<double>& sums, FeatureTables& tables) {
  freeze(sums.node, tables.node);
  freeze(sums.mesh_edge, tables.mesh_edge);
  freeze(sums.coarse_edge, tables.coarse_edge);
  freeze(sums.world_edge, tables.world_edge);
  freeze(sums.body_edge, tables.body_edge);
  freeze(sums.output, tables.output);
  freeze(sums.space_edge, tables.space_edge);
}

void embed_again(const FeatureOptions& options, const FeatureTables& tables, Graph& graph) {
  const EmbeddingColumns at = embedding_columns(options);
  embed_columns(tables.node_type, graph.node_types, at.type, options.type_columns, tables.node, graph.nodes);
  embed_columns(tables.vertex_level, graph.node_levels, at.level, options.level_columns, tables.node, graph.nodes);
  for (EdgeSet& set : graph.edge_sets)
    if (!set.labels.empty())
      embed_columns(tables.edge_type, set.labels, at.label, options.label_columns,
                    statistics_for(set.key, options, tables), set.features);
}

}  // namespace selvedge
