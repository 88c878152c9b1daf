#pragma once

#include <vector>

#include "learned/network/weights.hpp"

namespace selvedge {

// Latents inside the network, for comparisons. Rows of nodes and edges are in the order of the graph.
struct LatentTrace {
  std::vector<FeatureRows> nodes;                    // after the encoder and after each step
  std::vector<FeatureRows> edges_first, edges_last;  // one a set of the graph: after its encoder, and at the end
};

struct PackedNetwork;

// Output of the network for each cloth node: cloth_nodes x outputs, normalised, in float. The graph's feature rows are
// what the encoders see. A set whose key the architecture lacks, an index outside of the nodes or a wrong number of
// columns is an Error; a set that is absent has no edges. NaN goes through. 1 and n threads give the same bits.
//
// Each step updates all edges from the old latents of their nodes, e' = MLP(target, source, edge), then the nodes,
// h' = MLP(own, sums of e' by key), and adds h' and e' to the latents (parity README, rows 2 to 5).
//
// First layers of edge networks are split: their products with target and source are made once a node (Pfaff et al.
// 2021's "concat trick"). Memory beside the packed weights, in floats: a latent a node and an edge, one sum for each
// node that receives edges of a set, two products a node.
FeatureRows infer(const PackedNetwork&, const Graph&, LatentTrace* = nullptr);

// The same by plain matrix products, node by node and edge by edge, slow and clear: what `infer` is tested against.
FeatureRows infer_by_definition(const Architecture&, const NetworkWeights&, const Graph&, LatentTrace* = nullptr);

// Floating-point operations of `infer`'s matrix products, two a multiplication with addition, first layers split.
double count_operations(const Architecture&, const Graph&);
// Bytes that a run of `infer` allocates for latents, sums and products.
double count_bytes(const Architecture&, const Graph&);

}  // namespace selvedge
