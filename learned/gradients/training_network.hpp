#pragma once

#include <memory>

#include "learned/network/engine.hpp"
#include "learned/network/engine_kernels.hpp"

namespace selvedge {

// Derivatives in the shapes of the weights. Those of statistics stay zero.
using WeightGradients = NetworkWeights;
WeightGradients zero_gradients(const Architecture&);
void set_zero(const Architecture&, WeightGradients&);

struct TrainingLayout;

// A network in training. `weights` may be read at any time. Call `lay_out` after changing them and before the next
// forward run, because the kernels read their own layout.
struct TrainingNetwork {
  Architecture architecture;
  NetworkWeights weights;
  std::shared_ptr<TrainingLayout> layout;  // training_tape.hpp

  TrainingNetwork() = default;
  TrainingNetwork(TrainingNetwork&&) = default;
  TrainingNetwork& operator=(TrainingNetwork&&) = default;
};

// Throws Error unless the weights have the architecture's shapes and the machine has the instruction set.
TrainingNetwork make_training_network(const Architecture&, NetworkWeights, InstructionSet = best_instruction_set());
void lay_out(TrainingNetwork&);

struct TrainingTape;

// The stored results of a forward run for the backward one. The next run reuses its memory. One run of a network at a
// time writes to a tape; networks and graphs may be shared by several tapes.
class Tape {
 public:
  Tape();
  Tape(Tape&&) = default;
  TrainingTape& operator*() const { return *tape_; }

 private:
  std::shared_ptr<TrainingTape> tape_;
};

// Returns the decoder's output, cloth_nodes x outputs, as `infer` does (rounding differs: 1e-5 of the largest). Throws
// as `infer` does. 1 and n threads give the same bits.
FeatureRows run_forward(const TrainingNetwork&, const Graph&, Tape&);

// Adds to `gradients` the derivatives of a scalar with respect to every weight. `d_output` (cloth_nodes x outputs) is
// the derivative of the scalar with respect to the output of the last `run_forward` on this tape, with the same
// network, weights and graph. Embeddings get theirs through the normalised columns of the graph's features, whose
// deviations are those of weights.tables. Nothing is added for arrays that the graph does not use. 1 and n threads give
// the same bits. Throws Error where `d_output` or `gradients` has other shapes, or where the tape is of another graph.
void run_backward(const TrainingNetwork&, const Graph&, const Tape&, const FeatureRows& d_output,
                  WeightGradients& gradients);

}  // namespace selvedge
