#pragma once

#include "pipeline/drapes/drape_table.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {

struct DrapeTrainSummary {
  std::filesystem::path folder;
  bool finished = false;
  double seconds = 0;
  int training = 0, validation = 0, test = 0;  // number of drapes
  long long parameters = 0;                    // parameters of the backbone
  std::vector<DrapeTableRow> table;
  std::string distance;  // errors of the distance network, for people; empty: none
};

// Trains the backbone, the distance network where a row needs it, and every row from the backbone's end. Then it
// measures all of them on the test drapes, with post-processing and edge passes. Writes NAME.h5 and NAME.csv of each
// stage, table.txt, table.csv, config.yaml and training.html. Stops as `train` does, and continues with `resume`.
DrapeTrainSummary train_drapes(const TrainRequest&);

// Trains what the file asks for: a network of the stepper `learned` (train), or one of drapes. Texts are for people and
// as one JSON object. The latter is trained by one process: throws Error where there are several.
struct TrainedRun {
  std::string text, json;
  bool finished = false;
};
TrainedRun train_as_asked(const TrainRequest&);

}  // namespace selvedge
