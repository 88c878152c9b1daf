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
// history. The new file is renamed at the end. Where several processes train, every one writes what is its own in a
// part beside the file, and process 0 writes the file when all parts are there. Throws Error.
void write_training_checkpoint(const std::filesystem::path&, const Trainer&, const TrainingHistory&);

// A trainer that continues with the same bits on the same machine. Throws one Error for a file that is missing,
// damaged, foreign, of another configuration, or of another number of processes.
std::unique_ptr<Trainer> read_training_checkpoint(const std::filesystem::path&, const TrainingOptions&,
                                                  TrainingHistory&, Processes* = nullptr);

}  // namespace selvedge
