#pragma once

#include <functional>

#include "pipeline/drapes/drape_training_options.hpp"
#include "pipeline/drapes/stage_file_hdf5.hpp"
#include "pipeline/training/random_stream.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {

// One stage: a network is trained for a number of steps into a file of the run's folder. The file is the checkpoint
// during the stage and the result after it.
struct TrainingStage {
  std::string name;
  StageOptions options;
  std::string header;  // of the table, without step, seconds and rate
  // Takes one step and returns its columns for the table. `last`: the line is written, so that it may measure more.
  std::function<std::string(double rate, RandomStream&, bool last)> step;
  std::function<StageFile()> state;               // networks and numbers as they are; the rest is filled in
  std::function<void(const StageFile&)> restore;  // from them
};

struct StageRun {
  const TrainRequest& request;
  const DrapeTrainingOptions& options;
  std::filesystem::path folder;
  double seconds = 0;  // of all stages so far
};

// Trains it to its end, or goes on with it: false if it was stopped at a checkpoint. A stage of other options than the
// run's is refused (Error). Leaves NAME.h5 and NAME.csv.
bool run_stage(StageRun&, const TrainingStage&);

}  // namespace selvedge
