#pragma once

#include <torch/torch.h>

#include <vector>

#include "learned/gradients/torch_interface.hpp"

namespace selvedge {

// The node at one end of each edge. By node: the number of its edges, and the edges, one node after the other.
struct TorchEnds {
  torch::Tensor node, count, edge;
};

struct TorchEdges {
  torch::Tensor taken;  // rows of the set's latents; undefined: all of them
  TorchEnds receivers, senders;
};

// A graph as tensors.
struct TorchGraph {
  torch::Tensor nodes;
  std::vector<torch::Tensor> features;  // one per set
  std::vector<TorchEdges> selections;
};

// Copies a graph to the device: all features in one copy, all indices in another. `keys` is the number of selections of
// the view.
TorchGraph tensors_of(const TorchGraphView&, std::int64_t node_inputs, std::size_t keys, const torch::Device&);

}  // namespace selvedge
