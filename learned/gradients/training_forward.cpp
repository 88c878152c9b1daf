#include <algorithm>

#include "collision/geometry/parallel.hpp"
#include "learned/gradients/training_tape.hpp"

namespace selvedge {
namespace {

// The destination of the results of a perceptron's tile.
struct Destination {
  const float* const* from = nullptr;  // latents to which the results are added; null: none
  float* const* latent = nullptr;
  float* const* sum = nullptr;
};

// Computes the layers after the first, then the layer norm. Results lie on the tape from `slot` on.
void finish_forward(const TrainingRun& run, const PackedPerceptron& p, PerceptronTape& tape, int slot, int rows,
                    const Destination& to) {
  const float* input[training_rows];
  for (std::size_t layer = 0; layer < p.layers.size(); ++layer) {
    for (int r = 0; r < rows; ++r) input[r] = tape.hidden[layer].row(slot + r);
    fill_rows_up(input, rows);
    const bool last = layer + 1 == p.layers.size();
    LatentRows& out = last ? tape.values : tape.hidden[layer + 1];
    LayerTile tile = p.layers[layer].tile(input, out.row(slot), out.stride, rows);
    tile.rectify = !last;
    run.kernels.multiply(tile);
  }
  const bool norm = p.scale.size() > 0;
  run.training.norm({tape.values.row(slot), tape.values.stride, p.outputs, rows, norm ? p.scale.data() : nullptr,
                     p.shift.data(), norm ? tape.factor.data() + slot : nullptr, to.from, to.latent, to.sum});
}

// Calls work(begin, count) for the tiles of the rows, on all threads.
template <class Work>
void for_each_tile(int rows, const Work& work) {
  parallel_for(tiles_of(rows, training_rows), 1, [&](int tile) {
    const int begin = tile * training_rows;
    work(begin, std::min(training_rows, rows - begin));
  });
}

// Row i of `to` becomes the perceptron's result for row order[i] of `from` (row i without an order). The input is one
// block, and slots are rows.
void forward_rows(const TrainingRun& run, const PackedPerceptron& p, const float* from, std::ptrdiff_t from_stride,
                  const std::vector<int>* order, int rows, PerceptronTape& tape, float* to, std::ptrdiff_t to_stride) {
  for_each_tile(rows, [&](int begin, int count) {
    const float* input[training_rows];
    float* latent[training_rows];
    for (int r = 0; r < count; ++r) {
      input[r] = from + from_stride * (order ? (*order)[static_cast<std::size_t>(begin + r)] : begin + r);
      latent[r] = to + to_stride * (begin + r);
    }
    fill_rows_up(input, count);
    LatentRows& hidden = tape.hidden.front();
    LayerTile first = p.blocks.front().tile(input, hidden.row(begin), hidden.stride, count);
    first.rectify = true;
    run.kernels.multiply(first);
    finish_forward(run, p, tape, begin, count, {nullptr, latent, nullptr});
  });
}

// Row i of `products` becomes the layer's result for the latent of node list[i].
void multiply_nodes(const TrainingRun& run, const PackedLayer& layer, const LatentRows& nodes,
                    const std::vector<int>& list, LatentRows& products) {
  const int rows = static_cast<int>(list.size());
#pragma omp for schedule(dynamic, 1) nowait
  for (int tile = 0; tile < tiles_of(rows, training_rows); ++tile) {
    const int begin = tile * training_rows, count = std::min(training_rows, rows - begin);
    const float* input[training_rows];
    for (int r = 0; r < count; ++r) input[r] = nodes.row(list[static_cast<std::size_t>(begin + r)]);
    fill_rows_up(input, count);
    run.kernels.multiply(layer.tile(input, products.row(begin), products.stride, count));
  }
}

// One selection of edges in one step.
struct EdgeUpdate {
  const PackedPerceptron& p;
  const EdgeSelection& selection;
  const LatentRows& from;
  LatentRows &to, &sums;
  PerceptronTape& tape;
};

// Computes edges [begin, begin + count), the first of which lies at `slot`.
void forward_edge_tile(const TrainingRun& run, const EdgeUpdate& update, int begin, int count, int slot) {
  const EdgeSelection& selection = update.selection;
  const float *input[training_rows], *other[training_rows];
  float *latent[training_rows], *sum[training_rows];
  for (int r = 0; r < count; ++r) {
    const auto e = static_cast<std::size_t>(begin + r);
    input[r] = run.tape.to_receiver.row(selection.receiver[e]);
    other[r] = run.tape.to_sender.row(selection.sender[e]);
    prefetch_row(other[r], run.width());
  }
  LatentRows& hidden = update.tape.hidden.front();
  run.kernels.add_pairs({input, other, hidden.row(slot), hidden.stride, hidden.stride, count});
  for (int r = 0; r < count; ++r) {
    const auto e = static_cast<std::size_t>(begin + r);
    input[r] = update.from.row(selection.edge[e]);
    latent[r] = update.to.row(selection.edge[e]);
    sum[r] = update.sums.row(selection.receiver[e]);
  }
  fill_rows_up(input, count);
  LayerTile first = update.p.blocks[2].tile(input, hidden.row(slot), hidden.stride, count);
  first.go_on = first.rectify = true;
  run.kernels.multiply(first);
  finish_forward(run, update.p, update.tape, slot, count, {input, latent, sum});
}

void forward_edges(const TrainingRun& run, const LatentRows& nodes, const SlotPlan& slots, const EdgeUpdate& update) {
  const EdgeSelection& selection = update.selection;
  const int chunks = static_cast<int>(slots.chunk_slot.size());
  const std::size_t all = run.graph.edge_sets[static_cast<std::size_t>(selection.set)].senders.size();
  if (selection.edge.size() < all)
    std::copy_n(update.from.values.data(), all * static_cast<std::size_t>(update.from.stride), update.to.values.data());
#pragma omp parallel
  {
    multiply_nodes(run, update.p.blocks[0], nodes, selection.receivers, run.tape.to_receiver);
    multiply_nodes(run, update.p.blocks[1], nodes, selection.senders, run.tape.to_sender);
#pragma omp barrier
#pragma omp for schedule(dynamic, 1)
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const int begin = selection.chunks[static_cast<std::size_t>(chunk)];
      const int end = selection.chunks[static_cast<std::size_t>(chunk) + 1];
      const int slot = slots.chunk_slot[static_cast<std::size_t>(chunk)];
      if (begin == end) continue;
      const int first = selection.receiver[static_cast<std::size_t>(begin)];
      const int last = selection.receiver[static_cast<std::size_t>(end) - 1];
      std::fill(update.sums.row(first), update.sums.row(last + 1), 0.f);
      for (int e = begin; e < end; e += training_rows)
        forward_edge_tile(run, update, e, std::min(training_rows, end - e), slot + e - begin);
    }
  }
}

// Puts the sums of nodes [begin, begin + count) through the layer and adds the results to the nodes' rows of `out`.
// Nodes without a sum are skipped.
void add_sums(const TrainingRun& run, const PackedLayer& layer, const EdgeSelection& selection, const LatentRows& sums,
              int begin, int count, LatentRows& out) {
  const float* input[training_rows];
  float* to[training_rows];
  int found = 0;
  for (int r = 0; r < count; ++r) {
    const int receiver = selection.receiver_at[static_cast<std::size_t>(begin + r)];
    if (receiver < 0) continue;
    input[found] = sums.row(receiver);
    to[found++] = out.row(begin + r);
  }
  if (found == 0) return;
  fill_rows_up(input, found);
  if (found == count) {
    LayerTile tile = layer.tile(input, out.row(begin), out.stride, count);
    tile.go_on = true;
    run.kernels.multiply(tile);
    return;
  }
  LatentRows& mine = run.thread_rows().first;
  run.kernels.multiply(layer.tile(input, mine.row(0), mine.stride, found));
  run.training.add({mine.row(0), mine.stride, out.stride, found, to});
}

void forward_nodes(const TrainingRun& run, const PackedPerceptron& p, std::size_t step) {
  const std::vector<int>& selections = run.tape.plan.steps[step];
  StepTape& tape = run.tape.steps[step];
  const LatentRows& from = run.tape.nodes[step];
  LatentRows &to = run.tape.nodes[step + 1], &hidden = tape.node.hidden.front();
  const int rows = static_cast<int>(run.graph.nodes.rows());
  for_each_tile(rows, [&](int begin, int count) {
    const float* input[training_rows];
    float* latent[training_rows];
    for (int r = 0; r < count; ++r) {
      std::copy_n(p.blocks.front().bias.data(), hidden.stride, hidden.row(begin + r));
      input[r] = from.row(begin + r);
      latent[r] = to.row(begin + r);
    }
    for (std::size_t k = 0; k < selections.size(); ++k)
      if (selections[k] >= 0)
        add_sums(run, p.blocks[1 + k], run.tape.plan.selections[static_cast<std::size_t>(selections[k])], tape.sums[k],
                 begin, count, hidden);
    fill_rows_up(input, count);
    LayerTile own = p.blocks.front().tile(input, hidden.row(begin), hidden.stride, count);
    own.go_on = own.rectify = true;
    run.kernels.multiply(own);
    finish_forward(run, p, tape.node, begin, count, {input, latent, nullptr});
  });
}

void encode_forward(const TrainingRun& run, const PackedNetwork& network) {
  const Architecture& a = run.architecture;
  TrainingTape& tape = run.tape;
  forward_rows(run, network.node_encoder, run.graph.nodes.data(), a.node_inputs, nullptr,
               static_cast<int>(run.graph.nodes.rows()), tape.node_encoder, tape.nodes.front().values.data(),
               tape.nodes.front().stride);
  for (std::size_t s = 0; s < tape.keys.size(); ++s) {
    if (!tape.used[s]) continue;
    const EdgeSet& set = run.graph.edge_sets[s];
    const auto encoder = static_cast<std::size_t>(encoder_of(a, set.key));
    LatentRows& latents = tape.edges[s].front();
    forward_rows(run, network.encoders[encoder], set.features.data(), a.encoders[encoder].inputs, &tape.plan.order[s],
                 static_cast<int>(set.senders.size()), tape.edge_encoders[s], latents.values.data(), latents.stride);
  }
}

}  // namespace

FeatureRows run_forward(const TrainingNetwork& network, const Graph& graph, Tape& owner) {
  const Architecture& a = network.architecture;
  const PackedNetwork& packed = network.layout->forward;
  TrainingTape& tape = *owner;
  check_graph(a, graph);
  prepare_tape(a, graph, tape);
  const TrainingRun run = start_run(network, graph, tape);
  encode_forward(run, packed);
  for (std::size_t step = 0; step < a.steps.size(); ++step) {
    const std::vector<int>& selections = tape.plan.steps[step];
    for (std::size_t k = 0; k < selections.size(); ++k) {
      if (selections[k] < 0) continue;
      const auto index = static_cast<std::size_t>(selections[k]);
      const EdgeSelection& selection = tape.plan.selections[index];
      std::vector<LatentRows>& latents = tape.edges[static_cast<std::size_t>(selection.set)];
      const auto version = static_cast<std::size_t>(tape.steps[step].version[k]);
      forward_edges(run, tape.nodes[step], tape.slots[index],
                    {packed.steps[step].edges[k], selection, latents[version], latents[version + 1],
                     tape.steps[step].sums[k], tape.steps[step].edges[k]});
    }
    forward_nodes(run, packed.steps[step].node, step);
  }
  FeatureRows output(graph.cloth_nodes, a.outputs);
  const LatentRows& last = tape.nodes.back();
  forward_rows(run, packed.decoder, last.values.data(), last.stride, nullptr, graph.cloth_nodes, tape.decoder,
               output.data(), a.outputs);
  tape.complete = true;
  return output;
}

}  // namespace selvedge
