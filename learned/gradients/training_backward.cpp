#include <algorithm>

#include "collision/geometry/error.hpp"
#include "learned/gradients/embedding_gradients.hpp"
#include "learned/gradients/perceptron_back.hpp"

namespace selvedge {
namespace {

// Goes back through an encoder, whose input is one block of features. `d` has the derivatives by its results, row by
// row. Leaves those by the first layer's results in d_first. Row i belongs to row order[i] of `features`.
void back_encoder(const TrainingRun& run, const PackedPerceptron& forward, const PackedPerceptron& backward,
                  const PerceptronTape& tape, const FeatureRows& features, const std::vector<int>* order,
                  const LatentRows& d, Perceptron& gradient) {
  const int rows = static_cast<int>(features.rows()), inputs = static_cast<int>(features.cols());
  if (rows == 0) return;
  GradientParts& parts = run.tape.parts;
  parts.begin(tile_parts_of(rows));
  const PerceptronBack p{forward, backward, tape, add_places(parts, gradient)};
  const int first = parts.add(gradient.layers.front().weight, 0, inputs);
  parts.allocate();
  LatentRows& d_first = run.tape.d_first;
  for_tiles(parts, rows, [&](float* part, int begin, int count) {
    ThreadRows& mine = run.thread_rows();
    for (int r = 0; r < count; ++r) std::copy_n(d.row(begin + r), d.stride, mine.first.row(r));
    back_to_first(run, p, begin, count, part, d_first.row(begin), d_first.stride);
    const float* input[training_rows];
    for (int r = 0; r < count; ++r) {
      const int row = order ? (*order)[static_cast<std::size_t>(begin + r)] : begin + r;
      std::copy_n(features.row(row).data(), inputs, mine.third.row(r));
      input[r] = mine.third.row(r);
    }
    add_outer(run, d_first.row(begin), d_first.stride, run.width(), input, inputs, count, part + first,
              part + p.places.biases.front());
  });
}

void back_decoder(const TrainingRun& run, const PackedNetwork& forward, const PackedNetwork& backward,
                  const FeatureRows& d_output, WeightGradients& gradients) {
  LatentRows& d_nodes = run.tape.d_nodes;
  std::fill_n(d_nodes.values.data(), d_nodes.values.size(), 0.f);
  const int rows = run.graph.cloth_nodes, outputs = run.architecture.outputs;
  if (rows == 0) return;
  GradientParts& parts = run.tape.parts;
  parts.begin(tile_parts_of(rows));
  const PerceptronBack p{forward.decoder, backward.decoder, run.tape.decoder, add_places(parts, gradients.decoder)};
  const int first = parts.add(gradients.decoder.layers.front().weight, 0, run.width());
  parts.allocate();
  const LatentRows& nodes = run.tape.nodes.back();
  for_tiles(parts, rows, [&](float* part, int begin, int count) {
    ThreadRows& mine = run.thread_rows();
    float* d_first = mine.third.row(0);
    const float* input[training_rows];
    float* result[training_rows];
    for (int r = 0; r < count; ++r) {
      std::fill_n(mine.first.row(r), mine.first.stride, 0.f);
      std::copy_n(d_output.row(begin + r).data(), outputs, mine.first.row(r));
    }
    back_to_first(run, p, begin, count, part, d_first, mine.third.stride);
    for (int r = 0; r < count; ++r) {
      input[r] = nodes.row(begin + r);
      result[r] = d_nodes.row(begin + r);
    }
    add_outer(run, d_first, mine.third.stride, run.width(), input, run.width(), count, part + first,
              part + p.places.biases.front());
    contiguous_rows(d_first, mine.third.stride, count, input);
    run.kernels.multiply(backward.decoder.blocks.front().tile(input, mine.first.row(0), mine.first.stride, count));
    run.training.add({mine.first.row(0), mine.first.stride, d_nodes.stride, count, result});
  });
}

// Picks the edge sums of one kind at nodes [begin, begin + count), and packs the matching rows of `d_first`. Sets the
// rows of `d_sums` to zero. Returns how many there are.
int pick_sums(const EdgeSelection& selection, const LatentRows& sums, LatentRows& d_sums, const float* d_first,
              int stride, int begin, int count, float* packed, const float** input, float** result) {
  int found = 0;
  for (int r = 0; r < count; ++r) {
    const int receiver = selection.receiver_at[static_cast<std::size_t>(begin + r)];
    if (receiver < 0) continue;
    input[found] = sums.row(receiver);
    result[found] = d_sums.row(receiver);
    std::copy_n(d_first + static_cast<std::ptrdiff_t>(r) * stride, d_sums.stride,
                packed + static_cast<std::ptrdiff_t>(found) * stride);
    std::fill_n(d_sums.row(receiver), d_sums.stride, 0.f);
    ++found;
  }
  return found;
}

// Turns derivatives by the nodes after a step into those by the nodes before it, as far as they pass the node network.
// Leaves those by the sums in d_sums.
void back_nodes(const TrainingRun& run, const PackedPerceptron& forward, const PackedPerceptron& backward,
                std::size_t step, Perceptron& gradient) {
  const int rows = static_cast<int>(run.graph.nodes.rows()), width = run.width();
  if (rows == 0) return;
  TrainingTape& tape = run.tape;
  const std::vector<int>& selections = tape.plan.steps[step];
  GradientParts& parts = tape.parts;
  parts.begin(tile_parts_of(rows));
  const PerceptronBack p{forward, backward, tape.steps[step].node, add_places(parts, gradient)};
  std::vector<int> blocks;
  for (std::size_t k = 0; k <= selections.size(); ++k)
    blocks.push_back(k > 0 && selections[k - 1] < 0
                         ? -1
                         : parts.add(gradient.layers.front().weight, static_cast<Eigen::Index>(k) * width, width));
  parts.allocate();
  const LatentRows& nodes = tape.nodes[step];
  for_tiles(parts, rows, [&](float* part, int begin, int count) {
    ThreadRows& mine = run.thread_rows();
    const float* input[training_rows];
    float* result[training_rows];
    for (int r = 0; r < count; ++r) {
      result[r] = tape.d_nodes.row(begin + r);
      std::copy_n(result[r], tape.d_nodes.stride, mine.first.row(r));
    }
    float* d_first = tape.d_first.row(begin);
    const int d_stride = tape.d_first.stride;
    back_to_first(run, p, begin, count, part, d_first, d_stride);
    for (int r = 0; r < count; ++r) input[r] = nodes.row(begin + r);
    add_outer(run, d_first, d_stride, width, input, width, count, part + blocks[0], part + p.places.biases.front());
    add_product(run, backward.blocks[0], d_first, d_stride, count, result, tape.d_nodes.stride);
    for (std::size_t k = 0; k < selections.size(); ++k) {
      if (selections[k] < 0) continue;
      float* packed = mine.first.row(0);
      const int found =
          pick_sums(tape.plan.selections[static_cast<std::size_t>(selections[k])], tape.steps[step].sums[k],
                    tape.d_sums[k], d_first, d_stride, begin, count, packed, input, result);
      if (found == 0) continue;
      add_outer(run, packed, d_stride, width, input, width, found, part + blocks[1 + k], nullptr);
      add_product(run, backward.blocks[1 + k], packed, d_stride, found, result, tape.d_sums[k].stride);
    }
  });
}

// Adds derivatives by the latents of one end of the edges. `d_row(row, i)` writes the derivative by the first layer's
// product with node list[i]; the row is one of the thread's first rows.
template <class DRow>
void back_ends(const TrainingRun& run, const PackedLayer& transposed, const LatentRows& nodes,
               const std::vector<int>& list, FeatureRows& gradient, Eigen::Index block, DRow&& d_row) {
  const int rows = static_cast<int>(list.size()), width = run.width();
  GradientParts& parts = run.tape.parts;
  parts.begin(tile_parts_of(rows));
  const int place = parts.add(gradient, block * width, width);
  parts.allocate();
  for_tiles(parts, rows, [&](float* part, int begin, int count) {
    LatentRows& mine = run.thread_rows().first;
    const float* input[training_rows];
    float* result[training_rows];
    for (int r = 0; r < count; ++r) {
      d_row(mine.row(r), begin + r);
      const int node = list[static_cast<std::size_t>(begin + r)];
      input[r] = nodes.row(node);
      result[r] = run.tape.d_nodes.row(node);
    }
    add_outer(run, mine.row(0), mine.stride, width, input, width, count, part + place, nullptr);
    add_product(run, transposed, mine.row(0), mine.stride, count, result, run.tape.d_nodes.stride);
  });
}

// One selection of edges in one step of the backward pass.
struct EdgeBack {
  const PerceptronBack& p;
  const EdgeSelection& selection;
  const LatentRows &from, &d_sums;
  LatentRows& d_edges;
};

// Goes back through edges [begin, begin + count), the first of which lies at `slot`.
void back_edge_tile(const TrainingRun& run, const EdgeBack& back, int begin, int count, int slot, float* part,
                    int place) {
  const EdgeSelection& selection = back.selection;
  ThreadRows& mine = run.thread_rows();
  LatentRows& d_first = run.tape.d_first;
  const float *input[training_rows], *other[training_rows];
  float *d_edge[training_rows], *d_receiver[training_rows];
  for (int r = 0; r < count; ++r) {
    const auto e = static_cast<std::size_t>(begin + r);
    input[r] = d_edge[r] = back.d_edges.row(selection.edge[e]);
    other[r] = back.d_sums.row(selection.receiver[e]);
    d_receiver[r] = run.tape.to_receiver.row(selection.receiver[e]);
  }
  run.kernels.add_pairs({input, other, mine.first.row(0), mine.first.stride, d_first.stride, count});
  back_to_first(run, back.p, slot, count, part, d_first.row(slot), d_first.stride);
  for (int r = 0; r < count; ++r) input[r] = back.from.row(selection.edge[static_cast<std::size_t>(begin + r)]);
  add_outer(run, d_first.row(slot), d_first.stride, run.width(), input, run.width(), count, part + place,
            part + back.p.places.biases.front());
  add_product(run, back.p.backward.blocks[2], d_first.row(slot), d_first.stride, count, d_edge, back.d_edges.stride);
  run.training.add({d_first.row(slot), d_first.stride, d_first.stride, count, d_receiver});
}

// Goes back through the edges of the step's key k. Turns derivatives by the edges after the step into those before it,
// and adds those by the nodes to d_nodes.
void back_edges(const TrainingRun& run, const PackedPerceptron& forward, const PackedPerceptron& backward,
                std::size_t step, std::size_t k, Perceptron& gradient) {
  TrainingTape& tape = run.tape;
  const auto index = static_cast<std::size_t>(tape.plan.steps[step][k]);
  const EdgeSelection& selection = tape.plan.selections[index];
  const SlotPlan& slots = tape.slots[index];
  const auto set = static_cast<std::size_t>(selection.set);
  if (selection.edge.empty()) return;
  GradientParts& parts = tape.parts;
  const int chunks = static_cast<int>(slots.chunk_slot.size());
  FeatureRows& first_layer = gradient.layers.front().weight;
  parts.begin(chunks);
  const PerceptronBack p{forward, backward, tape.steps[step].edges[k], add_places(parts, gradient)};
  const int place = parts.add(first_layer, 2 * run.width(), run.width());
  parts.allocate();
  const EdgeBack back{p, selection, tape.edges[set][static_cast<std::size_t>(tape.steps[step].version[k])],
                      tape.d_sums[k], tape.d_edges[set]};
  for_parts(parts, chunks, 1, [&](float* part, int chunk, int) {
    const int begin = selection.chunks[static_cast<std::size_t>(chunk)];
    const int end = selection.chunks[static_cast<std::size_t>(chunk) + 1];
    const int slot = slots.chunk_slot[static_cast<std::size_t>(chunk)];
    const int first = selection.receiver[static_cast<std::size_t>(begin)];
    const int last = selection.receiver[static_cast<std::size_t>(end) - 1];
    std::fill(tape.to_receiver.row(first), tape.to_receiver.row(last + 1), 0.f);
    for (int e = begin; e < end; e += training_rows)
      back_edge_tile(run, back, e, std::min(training_rows, end - e), slot + e - begin, part, place);
  });
  const LatentRows& nodes = tape.nodes[step];
  back_ends(run, backward.blocks[0], nodes, selection.receivers, first_layer, 0,
            [&](float* to, int i) { std::copy_n(tape.to_receiver.row(i), tape.to_receiver.stride, to); });
  back_ends(run, backward.blocks[1], nodes, selection.senders, first_layer, 1, [&](float* to, int i) {
    const int begin = slots.sender_begin[static_cast<std::size_t>(i)];
    run.training.sum({tape.d_first.row(0), tape.d_first.stride, slots.sender_slots.data() + begin,
                      slots.sender_begin[static_cast<std::size_t>(i) + 1] - begin, tape.d_first.stride, to});
  });
}

void back_encoders(const TrainingRun& run, const PackedNetwork& forward, const PackedNetwork& backward,
                   const FeatureTables& tables, const NetworkWeights& weights, WeightGradients& gradients) {
  const Architecture& a = run.architecture;
  TrainingTape& tape = run.tape;
  for (std::size_t s = 0; s < tape.keys.size(); ++s) {
    if (!tape.used[s]) continue;
    const EdgeSet& set = run.graph.edge_sets[s];
    const auto encoder = static_cast<std::size_t>(encoder_of(a, set.key));
    back_encoder(run, forward.encoders[encoder], backward.encoders[encoder], tape.edge_encoders[s], set.features,
                 &tape.plan.order[s], tape.d_edges[s], gradients.encoders[encoder]);
    add_label_gradients(a, set, tape.plan.order[s], weights.encoders[encoder].layers.front().weight, tables,
                        tape.d_first, gradients.tables);
  }
  back_encoder(run, forward.node_encoder, backward.node_encoder, tape.node_encoder, run.graph.nodes, nullptr,
               tape.d_nodes, gradients.node_encoder);
  add_node_gradients(a, run.graph, weights.node_encoder.layers.front().weight, tables, tape.d_first, gradients.tables);
}

void check_backward(const TrainingNetwork& network, const Graph& graph, const TrainingTape& tape,
                    const FeatureRows& d_output, const WeightGradients& gradients) {
  const std::string where = "training of a network";
  if (!tape.complete || tape.cloth_nodes != graph.cloth_nodes || tape.node_rows != graph.nodes.rows() ||
      tape.keys.size() != graph.edge_sets.size())
    throw Error("going backward needs a tape of the same graph, written by going forward", where, "");
  if (d_output.rows() != graph.cloth_nodes || d_output.cols() != network.architecture.outputs)
    throw Error("a derivative is needed for each output of each cloth node", where, "");
  if (gradients.steps.size() != network.weights.steps.size() ||
      gradients.encoders.size() != network.weights.encoders.size())
    throw Error("the gradients have other shapes than the weights", where, "");
}

}  // namespace

void run_backward(const TrainingNetwork& network, const Graph& graph, const Tape& owner, const FeatureRows& d_output,
                  WeightGradients& gradients) {
  TrainingTape& tape = *owner;
  check_backward(network, graph, tape, d_output, gradients);
  const TrainingRun run = start_run(network, graph, tape);
  const PackedNetwork &forward = network.layout->forward, &backward = network.layout->backward;
  for (LatentRows& rows : tape.d_edges) std::fill_n(rows.values.data(), rows.values.size(), 0.f);
  back_decoder(run, forward, backward, d_output, gradients);
  for (std::size_t step = network.architecture.steps.size(); step-- > 0;) {
    StepWeights& to = gradients.steps[step];
    back_nodes(run, forward.steps[step].node, backward.steps[step].node, step, to.node);
    for (std::size_t k = 0; k < to.edges.size(); ++k)
      if (tape.plan.steps[step][k] >= 0)
        back_edges(run, forward.steps[step].edges[k], backward.steps[step].edges[k], step, k, to.edges[k]);
  }
  back_encoders(run, forward, backward, network.weights.tables, network.weights, gradients);
}

}  // namespace selvedge
