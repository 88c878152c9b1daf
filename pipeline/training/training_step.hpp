#pragma once

#include "pipeline/training/trainer.hpp"

namespace selvedge {

// The result of one step.
struct StepRecord {
  std::vector<SampleRecord> samples;
  AdamReport adam{.taken = false};  // not taken: no sample had a finite loss and gradient
};

// Takes `optimiser.batch` samples, each of another state of the pool, as one graph, and one step of the optimiser along
// the mean of their gradients. Samples without a finite loss are dropped. Throws Error after too many of them in a row.
// 1 and n threads give the same bits. Where several processes train, each takes so many samples, the mean is over those
// of all, and every one makes the same step (pipeline/processes); throws SharedFailure where another one has failed.
StepRecord train_step(Trainer&);

// The factor of the learning rate: half a cosine from 1 to 0 over the run, or 1/2 every `halving_steps` steps plus a
// floor (HOOD, released configuration), or 1. `progress` is the fraction of the run, 0 to 1.
double learning_factor(Decay, double progress, long step, long halving_steps, double floor);

}  // namespace selvedge
