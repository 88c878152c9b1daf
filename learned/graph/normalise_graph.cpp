#include <cmath>

#include "collision/geometry/error.hpp"
#include "learned/graph/make_graph.hpp"

namespace selvedge {
namespace {

// The member of tables or sums for a set of edges.
template <class Tables>
auto& part_for(const std::string& key, const FeatureOptions& options, Tables& tables) {
  if (key == options.body_key) return key == "body_edge" ? tables.body_edge : tables.world_edge;
  if (key == "mesh_edge" || (key.starts_with("coarse_edge") && options.shared_mesh_statistics)) return tables.mesh_edge;
  if (key.starts_with("coarse_edge")) return tables.coarse_edge;
  if (key == "space_edge") return tables.space_edge;
  return tables.world_edge;
}

int width_for(const std::string& key, const FeatureOptions& options) {
  if (key == options.body_key) return body_edge_widths(options).normalised;
  return key == "repulsion_edge" || key == "attraction_edge" ? cloth_edge_widths(options).normalised
                                                             : mesh_edge_widths(options).normalised;
}

void check_width(const std::string& what, std::size_t columns, int wanted) {
  if (columns != static_cast<std::size_t>(wanted))
    throw Error(
        "statistics of " + what + " have " + std::to_string(columns) + " columns in place of " + std::to_string(wanted),
        "weights of a learned stepper", "use weights with their own architecture");
}

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

const Statistics& statistics_for(const std::string& key, const FeatureOptions& options, const FeatureTables& tables) {
  return part_for(key, options, tables);
}

void normalise(const FeatureOptions& options, const FeatureTables& tables, Graph& graph) {
  for (EdgeSet& set : graph.edge_sets) {
    const Statistics& statistics = statistics_for(set.key, options, tables);
    check_width(set.key, statistics.mean.size(), width_for(set.key, options));
    normalise(statistics, set.features);
  }
  check_width("nodes", tables.node.mean.size(), node_widths(options).normalised);
  normalise(tables.node, graph.nodes);
}

FeatureSums<double> empty_sums(const FeatureOptions& options) {
  FeatureSums<double> sums;
  sums.node = DoubleAccumulators(node_widths(options).normalised);
  sums.output = DoubleAccumulators(3);
  for (const std::string& key : edge_set_keys(options))
    part_for(key, options, sums) = DoubleAccumulators(width_for(key, options));
  return sums;
}

void gather_and_normalise(const FeatureOptions& options, FeatureSums<float>& sums, FeatureTables& tables,
                          Graph& graph) {
  for (EdgeSet& set : graph.edge_sets) {
    Accumulators& of_set = part_for(set.key, options, sums);
    check_width(set.key, of_set.sum.size(), width_for(set.key, options));
    accumulate(of_set, set.features);
    Statistics& statistics = part_for(set.key, options, tables);
    statistics = statistics_of(of_set);
    normalise(statistics, set.features);
  }
  accumulate(sums.node, graph.nodes);
  tables.node = statistics_of(sums.node);
  normalise(tables.node, graph.nodes);
}

void gather(const FeatureOptions& options, const Graph& raw, const FeatureRows& accelerations,
            FeatureSums<double>& sums) {
  for (const EdgeSet& set : raw.edge_sets) accumulate(part_for(set.key, options, sums), set.features);
  accumulate(sums.node, raw.nodes);
  accumulate(sums.output, accelerations);
}

void freeze_statistics(const FeatureSums<double>& sums, FeatureTables& tables) {
  visit_statistics([](const char*, const DoubleAccumulators& of_set, Statistics& made) { freeze(of_set, made); }, sums,
                   tables);
}

}  // namespace selvedge
