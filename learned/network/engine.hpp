#pragma once

#include <vector>

#include "learned/network/graph_plan.hpp"
#include "learned/network/latent_rows.hpp"
#include "learned/network/weights.hpp"

namespace selvedge {

// Latents inside the network, for comparisons. Rows are in the order of the graph.
struct LatentTrace {
  std::vector<FeatureRows> nodes;                    // after the encoder and after each step
  std::vector<FeatureRows> edges_first, edges_last;  // one per set of the graph: after its encoder, and at the end
};

// Memory between runs of one network. It saves time and changes nothing: a graph with the edges of the last one has its
// plan, and memory is allocated once.
struct EngineMemory {
  std::vector<EdgeSet> ends;  // of the last graph, without features
  Eigen::Index node_count = -1;
  int cloth_nodes = 0;
  GraphPlan plan;
  LatentRows nodes;
  std::vector<LatentRows> edges;      // one per set, sorted by receiver
  LatentRows to_receiver, to_sender;  // products of the nodes in the first layers of the current selection
  std::vector<LatentRows> sums;       // one per key of a step, with one row per receiver
};

struct PackedNetwork;

// Output of the network for each cloth node: cloth_nodes x outputs, normalised, in float. Throws Error for a set whose
// key the architecture lacks, for an index outside of the nodes and for a wrong number of columns. An absent set has no
// edges. NaN goes through. 1 and n threads give the same bits.
//
// Each step updates all edges from the old latents of their nodes, e' = MLP(target, source, edge), then the nodes,
// h' = MLP(own, sums of e' by key), and adds h' and e' to the latents (parity README, rows 2 to 5).
//
// First layers of edge networks are split: their products with target and source are made once per node (Pfaff et al.
// 2021, "concat trick"). Memory beside the packed weights: a latent per node and edge, a sum per node that receives
// edges of a set, and two products per node, in floats.
FeatureRows infer(const PackedNetwork&, const Graph&, LatentTrace* = nullptr);
FeatureRows infer(const PackedNetwork&, const Graph&, EngineMemory&, LatentTrace* = nullptr);

// Floating-point operations of the matrix products in `infer`. A multiplication with addition counts as two.
double count_operations(const Architecture&, const Graph&);
// Bytes that a run of `infer` allocates for latents, sums and products.
double count_bytes(const Architecture&, const Graph&);

}  // namespace selvedge
