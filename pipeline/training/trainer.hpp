#pragma once

#include <memory>
#include <string>
#include <vector>

#include "learned/gradients/adam.hpp"
#include "learned/gradients/torch_network.hpp"
#include "learned/gradients/training_network.hpp"
#include "pipeline/formats/checkpoint.hpp"
#include "pipeline/training/roll_queue.hpp"
#include "pipeline/training/rolling_state.hpp"
#include "pipeline/training/trained_on.hpp"

namespace selvedge {

// What a run has counted.
struct TrainingCounts {
  long step = 0;                   // of the optimiser, bad samples not counted
  std::uint64_t rolls = 0;         // roll-outs that were asked for
  long frames = 0;                 // made in roll-outs
  long lost = 0;                   // roll-outs that went too far from the skinned garment
  long given_up = 0;               // .. that Bridson's response gave up
  long bad = 0, bad_in_a_row = 0;  // samples without a finite loss or gradient
};

// All that the next step depends on, beside what options and requests say.
struct Trainer {
  TrainingOptions options;
  Architecture architecture;
  TrainingNetwork network;
  std::unique_ptr<TorchNetwork> torch;  // computes `network` where the options name libtorch or a GPU; else null
  AdamState adam;
  FeatureSums<double> sums;
  RandomStream random;
  TrainingCounts counts;
  std::vector<RollingState> pool;
  std::unique_ptr<RollMaker> maker;
  std::unique_ptr<RollQueue> queue;
  RunInputs inputs;              // files of people, and a hash of what they and code have made
  TrainedOn trained_on;          // by this run and those whose weights it began with
  std::vector<int> start_pairs;  // of the roll-outs that this process has begun, where they are counted
  // Memory that is used again:
  Tape tape;
  Graph graph;
  WeightGradients gradients;
};

// What one step saw.
struct StepRecord {
  std::vector<LossTerm> terms;  // weights of now
  double sum = 0;               // [J]
  AdamReport adam;
  int pass = 0;
  bool settling = false;
  std::string bad;  // why the sample was left; empty: it was not
};

// The network that the options name.
Architecture trained_architecture(const TrainingOptions&);

// A trainer before its first step: world, first weights or those of an earlier stage, statistics of the warm-up, a full
// pool. Throws Error for weights of another network.
std::unique_ptr<Trainer> make_trainer(const TrainingOptions&);
// Everything but weights, statistics and states: what a resumed run begins with.
std::unique_ptr<Trainer> make_empty_trainer(const TrainingOptions&);

// Hands changed weights to what computes the network.
void place_network(Trainer&);

double progress_of(const Trainer&);  // part of the run, 0 to 1

// How frames are made at this point of the run.
FrameMaking frame_making(const Trainer&);

// One sample and one step of the optimiser. Throws Error where too many samples in a row had no finite loss.
StepRecord train_step(Trainer&);

// Gives a roll-out that has begun the guard that the options ask for.
void set_guard(const TrainingOptions&, RollingState&);

// Rolls that are asked for and not in the pool yet; the queue is kept at this length.
constexpr int rolls_ahead = 4;
void ask_for_roll(Trainer&);

}  // namespace selvedge
