#pragma once

#include <functional>

#include "pipeline/drapes/drape_training_options.hpp"
#include "pipeline/drapes/stage_file_hdf5.hpp"
#include "pipeline/training/random_stream.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {

// One stage trains a network for a number of steps, and writes a file into the run's folder. The file is the checkpoint
// during the stage and the result after it.
struct TrainingStage {
  std::string name;
  StageOptions options;
  std::string header;  // columns of the table after step, seconds and rate
  // Takes one step and returns its columns of the table. If `last`, the line is written, so the step may measure more.
  std::function<std::string(double rate, RandomStream&, bool last)> step;
  std::function<StageFile()> state;               // networks and numbers now; the caller fills in the rest
  std::function<void(const StageFile&)> restore;  // from such a file
};

struct StageRun {
  const TrainRequest& request;
  const DrapeTrainingOptions& options;
  std::filesystem::path folder;
  double seconds = 0;  // of all stages so far
};

// Trains the stage to its end, or continues it. Returns false if it was stopped at a checkpoint. Throws Error for a
// checkpoint of other options. Writes NAME.h5 and NAME.csv.
bool run_stage(StageRun&, const TrainingStage&);

}  // namespace selvedge
