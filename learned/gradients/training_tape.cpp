#include "learned/gradients/training_tape.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

int this_thread() {
#ifdef _OPENMP
  return omp_get_thread_num();
#else
  return 0;
#endif
}

constexpr int block_rows = 12;  // rows of every register block; a chunk's slots begin at a multiple of it

int whole_blocks(int rows) { return (rows + block_rows - 1) / block_rows * block_rows; }

// Enough chunks for many threads, but few enough that adding up their sums takes little time.
int edges_in_part(const Graph& graph) {
  std::size_t most = 0;
  for (const EdgeSet& set : graph.edge_sets) most = std::max(most, set.senders.size());
  const int wanted = static_cast<int>(most / 24);
  return std::max(240, (wanted + training_rows - 1) / training_rows * training_rows);
}

SlotPlan slot_plan(const EdgeSelection& selection) {
  SlotPlan plan;
  std::vector<int> slot_of(selection.edge.size());
  for (std::size_t c = 0; c + 1 < selection.chunks.size(); ++c) {
    const int begin = selection.chunks[c], end = selection.chunks[c + 1];
    plan.chunk_slot.push_back(plan.slots);
    for (int e = begin; e < end; ++e) slot_of[static_cast<std::size_t>(e)] = plan.slots + e - begin;
    plan.slots += whole_blocks(end - begin);
  }
  plan.sender_begin.assign(selection.senders.size() + 1, 0);
  for (const int sender : selection.sender) ++plan.sender_begin[static_cast<std::size_t>(sender) + 1];
  for (std::size_t s = 1; s < plan.sender_begin.size(); ++s) plan.sender_begin[s] += plan.sender_begin[s - 1];
  plan.sender_slots.resize(selection.edge.size());
  std::vector<int> next(plan.sender_begin.begin(), plan.sender_begin.end() - 1);
  for (std::size_t e = 0; e < selection.edge.size(); ++e)
    plan.sender_slots[static_cast<std::size_t>(next[static_cast<std::size_t>(selection.sender[e])]++)] = slot_of[e];
  return plan;
}

bool is_planned(const Architecture& a, const Graph& graph, const TrainingTape& tape) {
  if (tape.cloth_nodes != graph.cloth_nodes || tape.node_rows != graph.nodes.rows() ||
      tape.keys.size() != graph.edge_sets.size() || a.edge_kinds != tape.kinds || a.steps != tape.planned_steps)
    return false;
  for (std::size_t s = 0; s < tape.keys.size(); ++s)
    if (tape.keys[s] != graph.edge_sets[s].key || tape.senders[s] != graph.edge_sets[s].senders ||
        tape.receivers[s] != graph.edge_sets[s].receivers)
      return false;
  return true;
}

void make_plan(const Architecture& a, const Graph& graph, TrainingTape& tape) {
  tape.kinds = a.edge_kinds;
  tape.planned_steps = a.steps;
  tape.cloth_nodes = graph.cloth_nodes;
  tape.node_rows = graph.nodes.rows();
  tape.keys.clear();
  tape.senders.clear();
  tape.receivers.clear();
  for (const EdgeSet& set : graph.edge_sets) {
    tape.keys.push_back(set.key);
    tape.senders.push_back(set.senders);
    tape.receivers.push_back(set.receivers);
  }
  tape.plan = plan_graph(a, graph, edges_in_part(graph));
  tape.slots.clear();
  tape.used.assign(graph.edge_sets.size(), 0);
  for (const EdgeSelection& selection : tape.plan.selections) {
    tape.slots.push_back(slot_plan(selection));
    tape.used[static_cast<std::size_t>(selection.set)] = 1;
  }
}

void shape_perceptron(const Architecture& a, int slots, int outputs, bool norm, PerceptronTape& tape) {
  tape.hidden.resize(static_cast<std::size_t>(a.hidden_layers));
  for (LatentRows& rows : tape.hidden) rows.reshape(slots, a.width);
  tape.values.reshape(slots, outputs);
  if (norm && a.layer_norm) tape.factor.resize(static_cast<std::size_t>(slots));
}

void shape_steps(const Architecture& a, TrainingTape& tape) {
  std::vector<int> version(tape.keys.size(), 0);
  int most_receivers = 0, most_senders = 0, most_slots = 0;
  std::size_t most_keys = 0;
  tape.steps.resize(a.steps.size());
  for (std::size_t s = 0; s < a.steps.size(); ++s) {
    StepTape& step = tape.steps[s];
    const std::size_t keys = tape.plan.steps[s].size();
    most_keys = std::max(most_keys, keys);
    step.edges.resize(keys);
    step.sums.resize(keys);
    step.version.assign(keys, 0);
    for (std::size_t k = 0; k < keys; ++k) {
      const int index = tape.plan.steps[s][k];
      if (index < 0) continue;
      const EdgeSelection& selection = tape.plan.selections[static_cast<std::size_t>(index)];
      const int slots = tape.slots[static_cast<std::size_t>(index)].slots;
      shape_perceptron(a, slots, a.width, true, step.edges[k]);
      step.sums[k].reshape(static_cast<int>(selection.receivers.size()), a.width);
      step.version[k] = version[static_cast<std::size_t>(selection.set)]++;
      most_receivers = std::max(most_receivers, static_cast<int>(selection.receivers.size()));
      most_senders = std::max(most_senders, static_cast<int>(selection.senders.size()));
      most_slots = std::max(most_slots, slots);
    }
    shape_perceptron(a, static_cast<int>(tape.node_rows), a.width, true, step.node);
  }
  for (std::size_t set = 0; set < version.size(); ++set) {
    if (!tape.used[set]) continue;
    const int rows = static_cast<int>(tape.senders[set].size());
    tape.edges[set].resize(static_cast<std::size_t>(version[set]) + 1);
    for (LatentRows& latents : tape.edges[set]) latents.reshape(rows, a.width);
    tape.d_edges[set].reshape(rows, a.width);
    shape_perceptron(a, rows, a.width, true, tape.edge_encoders[set]);
    most_slots = std::max(most_slots, rows);
  }
  tape.to_receiver.reshape(most_receivers, a.width);
  tape.to_sender.reshape(most_senders, a.width);
  tape.d_first.reshape(std::max(most_slots, static_cast<int>(tape.node_rows)), a.width);
  tape.d_sums.resize(most_keys);
  for (LatentRows& rows : tape.d_sums) rows.reshape(most_receivers, a.width);
}

}  // namespace

ThreadRows& TrainingRun::thread_rows() const { return tape.threads[static_cast<std::size_t>(this_thread())]; }

void prepare_tape(const Architecture& a, const Graph& graph, TrainingTape& tape) {
  tape.complete = false;
  if (!is_planned(a, graph, tape)) make_plan(a, graph, tape);
  const int rows = static_cast<int>(tape.node_rows);
  tape.nodes.resize(a.steps.size() + 1);
  for (LatentRows& latents : tape.nodes) latents.reshape(rows, a.width);
  tape.edges.resize(tape.keys.size());
  tape.d_edges.resize(tape.keys.size());
  tape.edge_encoders.resize(tape.keys.size());
  shape_perceptron(a, rows, a.width, true, tape.node_encoder);
  shape_perceptron(a, graph.cloth_nodes, a.outputs, false, tape.decoder);
  shape_steps(a, tape);
  tape.d_nodes.reshape(rows, a.width);
}

TrainingRun start_run(const TrainingNetwork& network, const Graph& graph, TrainingTape& tape) {
  const Architecture& a = network.architecture;
  int widest = std::max({a.width, a.outputs, a.node_inputs});
  for (const EdgeEncoder& encoder : a.encoders) widest = std::max(widest, encoder.inputs);
  tape.threads.resize(static_cast<std::size_t>(most_threads()));
  for (ThreadRows& mine : tape.threads)
    for (LatentRows* buffer : {&mine.first, &mine.second, &mine.third}) buffer->reshape(training_rows, widest);
  const InstructionSet set = network.layout->forward.set;
  return {network.architecture, graph, tape, kernels_for(set), training_kernels_for(set)};
}

int tile_parts_of(int rows) { return tiles_of(rows, rows_in_part(rows)); }

int rows_in_part(int rows) { return std::max(3, tiles_of(tiles_of(rows, 24), training_rows)) * training_rows; }

Tape::Tape() : tape_(std::make_shared<TrainingTape>()) {}

WeightGradients zero_gradients(const Architecture& a) {
  WeightGradients gradients = blank_weights(a);
  set_zero(a, gradients);
  return gradients;
}

void set_zero(const Architecture& a, WeightGradients& gradients) {
  for (const WeightArray& array : weight_arrays(a, gradients))
    std::fill_n(array.data, static_cast<std::ptrdiff_t>(array.rows) * array.columns, 0.f);
}

TrainingNetwork make_training_network(const Architecture& a, NetworkWeights weights, InstructionSet set) {
  check_architecture(a, "network");
  check_weights(a, weights, "network");
  TrainingNetwork network;
  network.architecture = a;
  network.weights = std::move(weights);
  network.layout = std::make_shared<TrainingLayout>(
      TrainingLayout{packed_shapes(a, set, PackedWay::forward), packed_shapes(a, set, PackedWay::backward)});
  lay_out(network);
  return network;
}

void lay_out(TrainingNetwork& network) {
  pack_again(network.weights, PackedWay::forward, network.layout->forward);
  pack_again(network.weights, PackedWay::backward, network.layout->backward);
}

}  // namespace selvedge
