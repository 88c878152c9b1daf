#include "learned/network/engine.hpp"

#include <algorithm>

#include "collision/geometry/stop_scope.hpp"
#include "learned/network/engine_kernels.hpp"
#include "learned/network/packed_network.hpp"

namespace selvedge {
namespace {

// One thread's unit of work: a chunk has some tiles of edges, or one tile of nodes.
constexpr int edges_in_chunk = 192;

// Memory of one thread for one tile.
struct TileBuffers {
  int stride;
  AlignedFloats first, second;
  const float *input[tile_rows] = {}, *other[tile_rows] = {}, *first_row[tile_rows], *second_row[tile_rows];
  float *latent[tile_rows] = {}, *sum[tile_rows] = {};

  explicit TileBuffers(int columns)
      : stride(padded(columns)),
        first(static_cast<std::size_t>(tile_rows) * stride),
        second(static_cast<std::size_t>(tile_rows) * stride) {
    for (int r = 0; r < tile_rows; ++r) {
      first_row[r] = first.data() + static_cast<std::ptrdiff_t>(r) * stride;
      second_row[r] = second.data() + static_cast<std::ptrdiff_t>(r) * stride;
    }
  }
};

// One run of the network.
struct Pass {
  const PackedNetwork& network;
  const EngineKernels& kernels;
  const Graph& graph;
  const GraphPlan& plan;
  LatentRows& nodes;
  std::vector<LatentRows>& edges;
  LatentRows &to_receiver, &to_sender;
  std::vector<LatentRows>& sums;

  int width() const { return network.architecture.width; }
};

// Kernels read whole tiles, and results of the rows added here are not used.
void fill_up(const float** input, int rows) { std::fill(input + rows, input + tile_rows, input[0]); }

// Computes the layers after the first, whose results lie in `first`, then the layer norm. Writes or adds the results to
// `buffers.latent`, and adds them to `buffers.sum` if `sum`.
void finish_tile(const Pass& pass, const PackedPerceptron& p, TileBuffers& buffers, int rows, bool add, bool sum) {
  const float* const* input = buffers.first_row;
  float* values = buffers.first.data();
  for (std::size_t layer = 0; layer < p.layers.size(); ++layer) {
    const bool from_first = input == buffers.first_row;
    values = from_first ? buffers.second.data() : buffers.first.data();
    LayerTile tile = p.layers[layer].tile(input, values, buffers.stride, rows);
    tile.rectify = layer + 1 < p.layers.size();
    tile.next_weight = (tile.rectify ? p.layers[layer + 1] : p.blocks.back()).weight.data();
    pass.kernels.multiply(tile);
    input = from_first ? buffers.second_row : buffers.first_row;
  }
  pass.kernels.finish({values, buffers.stride, p.outputs, rows, p.scale.data(), p.shift.data(), buffers.latent, add,
                       sum ? buffers.sum : nullptr});
}

// Row i of `to` becomes the perceptron's result for row order[i] of `from` (row i without an order). The input is one
// block.
void evaluate_rows(const Pass& pass, const PackedPerceptron& p, const float* from, std::ptrdiff_t from_stride,
                   const std::vector<int>* order, int rows, float* to, std::ptrdiff_t to_stride) {
#pragma omp parallel
  {
    TileBuffers buffers(std::max(pass.width(), pass.network.architecture.outputs));
#pragma omp for schedule(dynamic, 1)
    for (int tile = 0; tile < tiles_of(rows); ++tile) {
      const int begin = tile * tile_rows, count = std::min(tile_rows, rows - begin);
      for (int r = 0; r < count; ++r) {
        buffers.input[r] = from + from_stride * (order ? (*order)[begin + r] : begin + r);
        buffers.latent[r] = to + to_stride * (begin + r);
      }
      fill_up(buffers.input, count);
      LayerTile first = p.blocks.front().tile(buffers.input, buffers.first.data(), buffers.stride, count);
      first.rectify = true;
      pass.kernels.multiply(first);
      finish_tile(pass, p, buffers, count, false, false);
    }
  }
}

// Row i of `products` becomes the layer's result for the latent of node list[i].
void multiply_nodes(const Pass& pass, const PackedLayer& layer, const std::vector<int>& list, LatentRows& products) {
  const int rows = static_cast<int>(list.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (int tile = 0; tile < tiles_of(rows); ++tile) {
    const int begin = tile * tile_rows, count = std::min(tile_rows, rows - begin);
    const float* input[tile_rows];
    for (int r = 0; r < count; ++r) input[r] = pass.nodes.row(list[begin + r]);
    fill_up(input, count);
    pass.kernels.multiply(layer.tile(input, products.row(begin), products.stride, count));
  }
}

void prefetch_edge_tile(const Pass& pass, const EdgeSelection& selection, int begin, int end) {
  for (int e = begin; e < std::min(begin + tile_rows, end); ++e) {
    prefetch_row(pass.edges[selection.set].row(selection.edge[e]), pass.width());
    prefetch_row(pass.to_sender.row(selection.sender[e]), pass.width());
  }
}

// Computes edges [begin, begin + count) of the selection from the products of both nodes. Adds the new value to the
// edge's latent and to the receiver's sum.
void update_edge_tile(const Pass& pass, const PackedPerceptron& p, const EdgeSelection& selection, int begin, int count,
                      LatentRows& latents, LatentRows& sums, TileBuffers& buffers) {
  for (int r = 0; r < count; ++r) {
    buffers.input[r] = pass.to_receiver.row(selection.receiver[begin + r]);
    buffers.other[r] = pass.to_sender.row(selection.sender[begin + r]);
  }
  pass.kernels.add_pairs({buffers.input, buffers.other, buffers.first.data(), buffers.stride, buffers.stride, count});
  for (int r = 0; r < count; ++r) {
    buffers.input[r] = buffers.latent[r] = latents.row(selection.edge[begin + r]);
    buffers.sum[r] = sums.row(selection.receiver[begin + r]);
  }
  fill_up(buffers.input, count);
  LayerTile first = p.blocks[2].tile(buffers.input, buffers.first.data(), buffers.stride, count);
  first.go_on = first.rectify = true;
  first.next_weight = p.layers.front().weight.data();
  pass.kernels.multiply(first);
  finish_tile(pass, p, buffers, count, true, true);
}

void update_edges(Pass& pass, const PackedPerceptron& p, const EdgeSelection& selection, LatentRows& sums) {
  multiply_nodes(pass, p.blocks[0], selection.receivers, pass.to_receiver);
  multiply_nodes(pass, p.blocks[1], selection.senders, pass.to_sender);
  LatentRows& latents = pass.edges[selection.set];
  const int chunks = static_cast<int>(selection.chunks.size()) - 1;
#pragma omp parallel
  {
    TileBuffers buffers(pass.width());
#pragma omp for schedule(dynamic, 1)
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const int begin = selection.chunks[chunk], end = selection.chunks[chunk + 1];
      if (begin == end) continue;
      std::fill(sums.row(selection.receiver[begin]), sums.row(selection.receiver[end - 1] + 1), 0.f);
      for (int e = begin; e < end; e += tile_rows) {
        prefetch_edge_tile(pass, selection, e + tile_rows, static_cast<int>(selection.edge.size()));
        update_edge_tile(pass, p, selection, e, std::min(tile_rows, end - e), latents, sums, buffers);
      }
    }
  }
}

// Sets `rows` to the sums of one kind of edges for nodes [begin, begin + count), or to zeros where a node has none.
// Returns false if none of them has a sum.
bool find_sums(const EdgeSelection& selection, const LatentRows& sums, int begin, int count, const float* zeros,
               const float** rows) {
  bool any = false;
  for (int r = 0; r < count; ++r) {
    const int receiver = selection.receiver_at[begin + r];
    any = any || receiver >= 0;
    rows[r] = receiver < 0 ? zeros : sums.row(receiver);
  }
  fill_up(rows, count);
  return any;
}

// Computes nodes [begin, begin + count): the own latent and the sums pass the first layer block by block. A block of
// sums is left out if none of these nodes has one.
void update_node_tile(const Pass& pass, const PackedPerceptron& p, const std::vector<int>& selections, int begin,
                      int count, const float* zeros, LatentRows& nodes, TileBuffers& buffers) {
  for (int r = 0; r < count; ++r) buffers.input[r] = buffers.latent[r] = nodes.row(begin + r);
  fill_up(buffers.input, count);
  LayerTile tile = p.blocks[0].tile(buffers.input, buffers.first.data(), buffers.stride, count);
  for (std::size_t k = 0; k < selections.size(); ++k) {
    if (selections[k] < 0) continue;
    const EdgeSelection& selection = pass.plan.selections[selections[k]];
    if (!find_sums(selection, pass.sums[k], begin, count, zeros, buffers.other)) continue;
    pass.kernels.multiply(tile);
    std::swap(buffers.input, buffers.other);
    tile = p.blocks[1 + k].tile(buffers.input, buffers.first.data(), buffers.stride, count);
    tile.go_on = true;
  }
  tile.rectify = true;
  tile.next_weight = p.layers.front().weight.data();
  pass.kernels.multiply(tile);
  finish_tile(pass, p, buffers, count, true, false);
}

void update_nodes(Pass& pass, const PackedPerceptron& p, const std::vector<int>& selections) {
  const AlignedFloats zeros(static_cast<std::size_t>(padded(pass.width())));
  const int rows = static_cast<int>(pass.graph.nodes.rows());
#pragma omp parallel
  {
    TileBuffers buffers(pass.width());
#pragma omp for schedule(dynamic, 1)
    for (int tile = 0; tile < tiles_of(rows); ++tile)
      update_node_tile(pass, p, selections, tile * tile_rows, std::min(tile_rows, rows - tile * tile_rows),
                       zeros.data(), pass.nodes, buffers);
  }
}

// Updates all edges from the old latents of the nodes, then the nodes.
void pass_messages(Pass& pass, std::size_t step) {
  const std::vector<int>& selections = pass.plan.steps[step];
  for (std::size_t k = 0; k < selections.size(); ++k)
    if (selections[k] >= 0)
      update_edges(pass, pass.network.steps[step].edges[k], pass.plan.selections[selections[k]], pass.sums[k]);
  update_nodes(pass, pass.network.steps[step].node, selections);
}

// Encodes the sets that a step uses, or all.
void encode(Pass& pass, bool all) {
  const Architecture& a = pass.network.architecture;
  evaluate_rows(pass, pass.network.node_encoder, pass.graph.nodes.data(), a.node_inputs, nullptr,
                static_cast<int>(pass.graph.nodes.rows()), pass.nodes.values.data(), pass.nodes.stride);
  for (std::size_t s = 0; s < pass.edges.size(); ++s) {
    if (!all && !is_used(pass.plan, s)) continue;
    const EdgeSet& set = pass.graph.edge_sets[s];
    const int encoder = encoder_of(a, set.key), rows = static_cast<int>(set.senders.size());
    pass.edges[s].reshape(rows, a.width);
    evaluate_rows(pass, pass.network.encoders[encoder], set.features.data(), a.encoders[encoder].inputs,
                  &pass.plan.order[s], rows, pass.edges[s].values.data(), pass.edges[s].stride);
  }
}

void allocate_passes(Pass& pass) {
  std::size_t most_receivers = 0, most_senders = 0;
  for (const EdgeSelection& selection : pass.plan.selections) {
    most_receivers = std::max(most_receivers, selection.receivers.size());
    most_senders = std::max(most_senders, selection.senders.size());
  }
  pass.nodes.reshape(static_cast<int>(pass.graph.nodes.rows()), pass.width());
  pass.edges.resize(pass.graph.edge_sets.size());
  pass.to_receiver.reshape(static_cast<int>(most_receivers), pass.width());
  pass.to_sender.reshape(static_cast<int>(most_senders), pass.width());
  for (const std::vector<int>& step : pass.plan.steps)
    for (std::size_t k = 0; k < step.size(); ++k) {
      if (pass.sums.size() <= k) pass.sums.emplace_back();
      const std::size_t rows = step[k] < 0 ? 0 : pass.plan.selections[step[k]].receivers.size();
      pass.sums[k].reshape(static_cast<int>(rows), pass.width());
    }
}

FeatureRows copy_nodes(const Pass& pass) {
  FeatureRows rows(pass.graph.nodes.rows(), pass.width());
  for (int i = 0; i < rows.rows(); ++i) std::copy_n(pass.nodes.row(i), pass.width(), rows.row(i).data());
  return rows;
}

// Rows are in the order of the graph.
std::vector<FeatureRows> copy_edges(const Pass& pass) {
  std::vector<FeatureRows> copies;
  for (std::size_t s = 0; s < pass.edges.size(); ++s) {
    const std::vector<int>& order = pass.plan.order[s];
    FeatureRows& rows = copies.emplace_back(static_cast<Eigen::Index>(order.size()), pass.width());
    for (std::size_t e = 0; e < order.size(); ++e)
      std::copy_n(pass.edges[s].row(static_cast<int>(e)), pass.width(), rows.row(order[e]).data());
  }
  return copies;
}

bool has_edges_of(const Graph& graph, const EngineMemory& memory) {
  return graph.nodes.rows() == memory.node_count && graph.cloth_nodes == memory.cloth_nodes &&
         std::ranges::equal(graph.edge_sets, memory.ends, [](const EdgeSet& a, const EdgeSet& b) {
           return a.key == b.key && a.senders == b.senders && a.receivers == b.receivers;
         });
}

// Plans anew where the edges are others than in the last run.
void plan_edges(const Architecture& a, const Graph& graph, EngineMemory& memory) {
  if (has_edges_of(graph, memory)) return;
  memory.node_count = -1;  // nothing is known if an exception leaves the plan half made
  memory.plan = plan_graph(a, graph, edges_in_chunk);
  memory.ends.clear();
  for (const EdgeSet& set : graph.edge_sets) memory.ends.push_back({set.key, set.senders, set.receivers, {}, {}});
  memory.cloth_nodes = graph.cloth_nodes;
  memory.node_count = graph.nodes.rows();
}

}  // namespace

FeatureRows infer(const PackedNetwork& network, const Graph& graph, LatentTrace* trace) {
  EngineMemory memory;
  return infer(network, graph, memory, trace);
}

FeatureRows infer(const PackedNetwork& network, const Graph& graph, EngineMemory& memory, LatentTrace* trace) {
  const Architecture& a = network.architecture;
  check_graph(a, graph);
  plan_edges(a, graph, memory);
  Pass pass{network,
            kernels_for(network.set),
            graph,
            memory.plan,
            memory.nodes,
            memory.edges,
            memory.to_receiver,
            memory.to_sender,
            memory.sums};
  allocate_passes(pass);
  encode(pass, trace != nullptr);
  if (trace) *trace = {{copy_nodes(pass)}, copy_edges(pass), {}};
  for (std::size_t step = 0; step < a.steps.size(); ++step) {
    check_stop();
    pass_messages(pass, step);
    if (trace) trace->nodes.push_back(copy_nodes(pass));
  }
  if (trace) trace->edges_last = copy_edges(pass);
  FeatureRows output(graph.cloth_nodes, a.outputs);
  evaluate_rows(pass, network.decoder, pass.nodes.values.data(), pass.nodes.stride, nullptr, graph.cloth_nodes,
                output.data(), a.outputs);
  return output;
}

}  // namespace selvedge
