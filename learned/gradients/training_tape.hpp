#pragma once

#include "learned/gradients/gradient_parts.hpp"
#include "learned/gradients/training_kernels.hpp"
#include "learned/gradients/training_network.hpp"
#include "learned/network/graph_plan.hpp"
#include "learned/network/packed_network.hpp"

namespace selvedge {

// Weights as the kernels read them.
struct TrainingLayout {
  PackedNetwork forward, backward;
};

// Stored by the forward pass of one perceptron, one row per slot: outputs of the hidden layers, and the result before
// scale and shift.
struct PerceptronTape {
  std::vector<LatentRows> hidden;
  LatentRows values;
  std::vector<float> factor;  // 1 / deviation of the layer norm
};

// Places of a selection's edges on a tape. Each chunk has its own slots, in whole register blocks.
struct SlotPlan {
  std::vector<int> chunk_slot;  // first slot of each chunk
  int slots = 0;
  std::vector<int> sender_begin, sender_slots;  // slots of sender s: sender_slots[sender_begin[s] ..]
};

// Buffers of one thread.
struct ThreadRows {
  LatentRows first, second, third;
};

struct StepTape {
  std::vector<PerceptronTape> edges;  // one per key
  std::vector<LatentRows> sums;       // one per key, with one row per receiver
  std::vector<int> version;           // one per key: which version of the set's latents the step reads
  PerceptronTape node;
};

struct TrainingTape {
  // The inputs of the plan, which is kept while they stay the same.
  std::vector<EdgeKind> kinds;
  std::vector<MessageStep> planned_steps;
  std::vector<std::vector<int>> senders, receivers;
  std::vector<std::string> keys;
  int cloth_nodes = -1;
  Eigen::Index node_rows = -1;
  GraphPlan plan;
  std::vector<SlotPlan> slots;  // one per selection
  std::vector<char> used;       // whether a step uses the set

  std::vector<LatentRows> nodes;               // latents after the encoder and after each step
  std::vector<std::vector<LatentRows>> edges;  // of each set: latents after its encoder and each step that uses it
  PerceptronTape node_encoder, decoder;
  std::vector<PerceptronTape> edge_encoders;  // one per set
  std::vector<StepTape> steps;

  // Memory for both passes.
  LatentRows to_receiver, to_sender;
  std::vector<ThreadRows> threads;
  // Memory for the backward pass.
  LatentRows d_nodes, d_first;
  std::vector<LatentRows> d_edges, d_sums;
  GradientParts parts;
  bool complete = false;  // a forward run has filled it
};

// One run, forward or backward.
struct TrainingRun {
  const Architecture& architecture;
  const Graph& graph;
  TrainingTape& tape;
  const EngineKernels& kernels;
  const TrainingKernels& training;

  int width() const { return architecture.width; }
  ThreadRows& thread_rows() const;
};

// Gives each thread its rows.
TrainingRun start_run(const TrainingNetwork&, const Graph&, TrainingTape&);

// Plans the graph unless the tape has its plan already, and sets the sizes of all rows.
void prepare_tape(const Architecture&, const Graph&, TrainingTape&);

// Kernels read whole tiles, and results of the rows added here are not used.
inline void fill_rows_up(const float** rows, int count) {
  for (int r = count; r < training_rows; ++r) rows[r] = rows[0];
}

// The number of rows in one thread's part, whole tiles, and the number of parts.
int rows_in_part(int rows);
int tile_parts_of(int rows);

}  // namespace selvedge
