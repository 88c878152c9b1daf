#pragma once

#include <filesystem>
#include <string>

#include "pipeline/training/trainer.hpp"

namespace selvedge {

// The records of a run so far, beside its state.
struct TrainingHistory {
  std::string steps, measures;  // lines of the tables, each with a newline
  double seconds = 0;           // time of training
  double best_score = 0;        // of the roll-out with the best weights; 0: none yet
  long best_step = 0;
};

// Writes the state of a training: weights, Adam, statistics, pool, requested roll-outs, random state, counts and
// history. The new file is renamed at the end. Throws Error.
void write_training_checkpoint(const std::filesystem::path&, const Trainer&, const TrainingHistory&);

// A trainer that continues with the same bits on the same machine. Throws one Error for a file that is missing,
// damaged, foreign, or of another configuration.
std::unique_ptr<Trainer> read_training_checkpoint(const std::filesystem::path&, const TrainingOptions&,
                                                  TrainingHistory&);

}  // namespace selvedge
