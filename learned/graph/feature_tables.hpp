#pragma once

#include "learned/graph/statistics.hpp"

namespace selvedge {

// What turns raw features into network inputs, and the network's output into an acceleration: it is learned or gathered
// in training, and travels in the weight file. A set that a model lacks is empty. In HOOD mesh and coarse edges share
// `mesh_edge`; edges to the body are `world_edge` in HOOD and `body_edge` in ContourCraft.
struct FeatureTables {
  Statistics node, mesh_edge, coarse_edge, world_edge, body_edge, output;
  FeatureRows node_type, vertex_level, edge_type;  // learned embeddings, one row a value
  Statistics space_edge;
};

// What is gathered of the same sets in training.
template <class Real>
struct FeatureSums {
  BasicAccumulators<Real> node, mesh_edge, coarse_edge, world_edge, body_edge, output, space_edge;
};

}  // namespace selvedge
