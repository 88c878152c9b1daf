#pragma once

#include <memory>
#include <string>
#include <vector>

#include "learned/gradients/adam.hpp"
#include "learned/gradients/torch_network.hpp"
#include "learned/gradients/training_network.hpp"
#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/processes/processes.hpp"
#include "pipeline/training/roll_queue.hpp"
#include "pipeline/training/rolling_state.hpp"
#include "pipeline/training/taught_states.hpp"
#include "pipeline/training/teacher.hpp"
#include "pipeline/training/trained_on.hpp"

namespace selvedge {

// Counts of a run.
struct TrainingCounts {
  long step = 0;                   // steps of the optimiser, without bad samples
  std::uint64_t rolls = 0;         // roll-outs requested
  long frames = 0;                 // frames made in roll-outs
  long lost = 0;                   // roll-outs that went too far from the skinned garment
  long given_up = 0;               // roll-outs in which Bridson's response gave up
  long bad = 0, bad_in_a_row = 0;  // samples without a finite loss or gradient
  long again = 0;                  // samples from states that were learned from before
};

// What one sample gave in a step.
struct SampleRecord {
  std::vector<LossTerm> terms;  // with their current weights
  double sum = 0;               // [J]
  int pass = 0;
  std::string bad;  // reason why the sample was dropped; empty: none
};

// A state in a step.
struct Sample {
  RollingState* state = nullptr;  // of the pool, or that of `again`
  TaughtState* again = nullptr;   // not null: its network and losses are as they were, and it does not go on
  Graph graph;
  std::unique_ptr<TaughtState> kept;  // of a state of the pool, where it is learned from again later
  NextCloth next;                     // the network's result
  FeatureRows d_output;               // derivative of the objective by the network's output
  SampleRecord record;
};

// The state of a training, beside its options and requests.
struct Trainer {
  TrainingOptions options;
  Processes* processes = nullptr;  // that train the same weights on samples of their own; null: one process
  Architecture architecture;
  TrainingNetwork network;
  std::unique_ptr<TorchNetwork> torch;  // runs `network` if the options name libtorch or a GPU; else null
  AdamState adam;
  FeatureSums<double> sums;  // of all processes
  RandomStream random;
  TrainingCounts counts;
  std::vector<RollingState> pool;
  std::unique_ptr<RollMaker> maker;
  std::unique_ptr<RollQueue> queue;
  std::unique_ptr<Teacher> teacher;  // null: no term of the objective needs one
  TaughtStates taught;
  RunInputs inputs;              // files of people, and a hash of the training world
  TrainedOn trained_on;          // includes the runs whose weights it began with
  std::vector<int> start_pairs;  // of the roll-outs begun by this process, where they are counted
  // Memory that is used again:
  Tape tape;
  std::vector<Sample> samples;
  Graph graph;  // of all samples, or of a state that is measured
  WeightGradients gradients;
};

// The network that the options name.
Architecture trained_architecture(const TrainingOptions&);

// A trainer before its first step: world, first weights or those of an earlier stage, warm-up statistics, and requests
// for the first roll-outs. Where several processes train, each makes one, and all have the same weights and statistics.
// Throws Error for weights of another network, and SharedFailure where processes have other options or other inputs.
std::unique_ptr<Trainer> make_trainer(const TrainingOptions&, Processes* = nullptr);
// A trainer without weights, statistics and states, for a resumed run.
std::unique_ptr<Trainer> make_empty_trainer(const TrainingOptions&, Processes* = nullptr);

int rank_of(const Trainer&);        // among the processes; 0 for one
int process_count(const Trainer&);  // 1 for one

// Passes changed weights to the kernels or to libtorch.
void place_network(Trainer&);

double progress_of(const Trainer&);  // fraction of the run, 0 to 1

// The options of frames at this point of the run.
FrameMaking frame_making(const Trainer&);

// Has the teacher, if there is one, make the frame that the state is about to make, and waits for it.
void teach(Trainer&, RollingState&);

// Gives a new roll-out the guard, and what runs behind the network, that the options ask for.
void set_guard(const TrainingOptions&, RollingState&);

// The number of requested roll-outs before the pool.
constexpr int rolls_ahead = 4;
// Asks for the next roll-out. Process r of n has those of numbers r, r + n, r + 2 n and so on.
void ask_for_roll(Trainer&);

}  // namespace selvedge
