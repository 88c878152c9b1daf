#include "learned/torch/graph_torch.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace selvedge {
namespace {

using torch::Tensor;

// Small arrays that go to the device in one copy, one after the other. A copy each would cost more than the network.
template <class Number>
class Parcel {
 public:
  void add(const Number* values, std::int64_t count) {
    pieces_.emplace_back(values, count);
    size_ += count;
  }
  // The place of each piece.
  std::vector<Tensor> sent(const torch::Device& device) const {
    const auto options = torch::TensorOptions(c10::CppTypeToScalarType<Number>::value).pinned_memory(device.is_cuda());
    const Tensor host = torch::empty({size_}, options);
    Number* to = host.data_ptr<Number>();
    for (const auto& [values, count] : pieces_) to = std::copy_n(values, count, to);
    const Tensor there = host.to(device);
    std::vector<Tensor> parts;
    std::int64_t at = 0;
    for (const auto& [values, count] : pieces_) {
      parts.push_back(there.narrow(0, at, count));
      at += count;
    }
    return parts;
  }

 private:
  std::vector<std::pair<const Number*, std::int64_t>> pieces_;
  std::int64_t size_ = 0;
};

// The lists of TorchEnds, one after the other.
struct EndLists {
  std::vector<std::int64_t> node, count, edge;

  EndLists(const std::int64_t* nodes_of_edges, std::int64_t edges, std::int64_t nodes)
      : node(nodes_of_edges, nodes_of_edges + edges), count(static_cast<std::size_t>(nodes)), edge(node.size()) {
    for (const std::int64_t n : node) ++count[static_cast<std::size_t>(n)];
    std::vector<std::int64_t> next(count.size());
    std::partial_sum(count.begin(), count.end() - 1, next.begin() + 1);
    for (std::size_t e = 0; e < node.size(); ++e)
      edge[static_cast<std::size_t>(next[static_cast<std::size_t>(node[e])]++)] = static_cast<std::int64_t>(e);
  }
  void add_to(Parcel<std::int64_t>& parcel) const {
    for (const std::vector<std::int64_t>* list : {&node, &count, &edge})
      parcel.add(list->data(), static_cast<std::int64_t>(list->size()));
  }
};

// The different selections of a graph, and the selection of each key of each step. Most steps share them.
struct DifferentSelections {
  std::vector<const TorchSelection*> all;
  std::vector<std::size_t> of_key;

  DifferentSelections(const TorchGraphView& view, std::size_t keys) {
    for (std::size_t i = 0; i < keys; ++i) {
      const TorchSelection& selection = view.selections[i];
      const auto same = [&](const TorchSelection* other) {
        return other->set == selection.set && other->receiver == selection.receiver;
      };
      const auto found = std::find_if(all.begin(), all.end(), same);
      of_key.push_back(static_cast<std::size_t>(found - all.begin()));
      if (found == all.end()) all.push_back(&selection);
    }
  }
};

std::vector<TorchEdges> edges_of(const DifferentSelections& selections, std::int64_t nodes,
                                 const torch::Device& device) {
  std::vector<EndLists> lists;
  for (const TorchSelection* selection : selections.all)
    for (const std::int64_t* ends : {selection->receiver, selection->sender})
      lists.emplace_back(ends, selection->set < 0 ? 0 : selection->edges, nodes);
  Parcel<std::int64_t> parcel;
  for (const EndLists& list : lists) list.add_to(parcel);
  for (const TorchSelection* selection : selections.all)
    parcel.add(selection->edge, selection->all != 0 || selection->set < 0 ? 0 : selection->edges);
  const std::vector<Tensor> sent = parcel.sent(device);
  std::vector<TorchEdges> edges(selections.all.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Tensor* at = &sent[6 * k];
    edges[k].receivers = {at[0], at[1], at[2]};
    edges[k].senders = {at[3], at[4], at[5]};
    if (selections.all[k]->all == 0) edges[k].taken = sent[6 * edges.size() + k];
  }
  return edges;
}

}  // namespace

TorchGraph tensors_of(const TorchGraphView& view, std::int64_t node_inputs, std::size_t keys,
                      const torch::Device& device) {
  Parcel<float> floats;
  floats.add(view.node_features, view.nodes * node_inputs);
  for (int s = 0; s < view.sets; ++s)
    floats.add(view.edge_sets[s].features, view.edge_sets[s].edges * view.edge_sets[s].inputs);
  const std::vector<Tensor> values = floats.sent(device);
  TorchGraph graph;
  graph.nodes = values[0].view({view.nodes, -1});
  for (int s = 0; s < view.sets; ++s)
    graph.features.push_back(
        values[static_cast<std::size_t>(s) + 1].view({view.edge_sets[s].edges, view.edge_sets[s].inputs}));
  const DifferentSelections selections(view, keys);
  const std::vector<TorchEdges> edges = edges_of(selections, view.nodes, device);
  for (const std::size_t different : selections.of_key) graph.selections.push_back(edges[different]);
  return graph;
}

}  // namespace selvedge
