#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "pipeline/training/training_watch.hpp"

namespace selvedge {

struct TrainRequest {
  std::filesystem::path config;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path out;           // folder; empty: out/training/NAME
  bool resume = false;                 // continue from the folder's checkpoint
  std::ostream* log = nullptr;         // gets a line now and then
  std::function<bool()> stop;          // called after every step; true ends the run at a checkpoint
  Processes* processes = nullptr;      // that train together, all with this request; null: this one alone
};

struct TrainSummary {
  std::filesystem::path folder;
  bool finished = false;  // false: stopped at a checkpoint
  TrainingCounts counts;
  double seconds = 0;  // time of training over all parts of the run
  long best_step = 0;
  double best_score = 0;
  std::string score_unit = "J";  // J: of the roll-out's energy; mm: of its distance from the solver
  TrainingMeasure last;
};

// Trains a network into a folder: checkpoint.h5, weights.h5 (the last), best.h5 (with the least energy of the measuring
// roll-out, or with a teacher those nearest to the solver), steps.csv, measures.csv, training.html and config.yaml.
// `stop` or pause_training stops it at a checkpoint. Of several processes the first alone writes files, but for parts
// of the checkpoint, and says how it goes on; `stop` of any of them stops all. Throws Error, in several processes on
// all of them: SharedFailure.
TrainSummary train(const TrainRequest&);

// The summary for people and as one JSON object.
std::string train_text(const TrainSummary&);
std::string train_json(const TrainSummary&);

// The file that asks the run in the folder to stop while it exists.
std::filesystem::path pause_file(const std::filesystem::path& folder);

// Asks the run in the folder to stop at a checkpoint and waits for at most `seconds`. Returns false if it has not
// stopped, or none runs there.
bool pause_training(const std::filesystem::path& folder, double seconds);

}  // namespace selvedge
