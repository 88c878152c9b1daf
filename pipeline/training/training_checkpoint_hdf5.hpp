#pragma once

#include <filesystem>
#include <string>

#include "pipeline/training/trainer.hpp"

namespace selvedge {

// What a run has written down so far, beside its state.
struct TrainingHistory {
  std::string steps, measures;  // lines of the tables, each with a newline
  double seconds = 0;           // that it has trained
  double best_score = 0;        // of the roll-out whose weights are kept as best; 0: none yet
  long best_step = 0;
};

// All that training goes on from: weights, Adam, statistics, pool, roll-outs asked for, random state, counts, history.
// Written beside and renamed. Throws Error.
void write_training_checkpoint(const std::filesystem::path&, const Trainer&, const TrainingHistory&);

// A trainer that goes on with the same bits on the same machine. Throws one Error for a file that is missing, damaged,
// foreign, or of another configuration.
std::unique_ptr<Trainer> read_training_checkpoint(const std::filesystem::path&, const TrainingOptions&,
                                                  TrainingHistory&);

}  // namespace selvedge
