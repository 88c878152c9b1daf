#pragma once

#include "learned/graph/statistics.hpp"

namespace selvedge {

// Statistics and embeddings that turn raw features into network inputs, and the network's output into an acceleration.
// Training gathers or learns them, and the weight file holds them. A set that a model lacks is empty. In HOOD mesh and
// coarse edges share `mesh_edge`. Edges to the body are `world_edge` in HOOD, `body_edge` in ContourCraft.
struct FeatureTables {
  Statistics node, mesh_edge, coarse_edge, world_edge, body_edge, output;
  FeatureRows node_type, vertex_level, edge_type;  // learned embeddings, one row per value
  Statistics space_edge;
};

// The sums from which training makes the statistics of the same sets.
template <class Real>
struct FeatureSums {
  BasicAccumulators<Real> node, mesh_edge, coarse_edge, world_edge, body_edge, output, space_edge;
};

// Calls `visit` with the name of each set and its member in the tables, sums or sizes (StatisticsSizes) that are given.
template <class Visit, class... Sets>
void visit_statistics(const Visit& visit, Sets&... sets) {
  visit("node", sets.node...);
  visit("mesh_edge", sets.mesh_edge...);
  visit("coarse_edge", sets.coarse_edge...);
  visit("world_edge", sets.world_edge...);
  visit("body_edge", sets.body_edge...);
  visit("output", sets.output...);
  visit("space_edge", sets.space_edge...);
}

}  // namespace selvedge
