#pragma once

#include "pipeline/drapes/drape_table.hpp"
#include "pipeline/training/train.hpp"

namespace selvedge {

struct DrapeTrainSummary {
  std::filesystem::path folder;
  bool finished = false;
  double seconds = 0;
  int training = 0, validation = 0, test = 0;  // drapes
  long long parameters = 0;                    // of the backbone
  std::vector<DrapeTableRow> table;
  std::string distance;  // of the network of distances, for people; empty without one
};

// Trains the backbone, the distance by a network where a row needs it, and every row from the backbone's end; then
// measures all of them on the test drapes, with post-processing and edge passes. Leaves NAME.h5 and NAME.csv of each
// stage, table.txt, table.csv, config.yaml and training.html. Stops as `train` does, and goes on with `resume`.
DrapeTrainSummary train_drapes(const TrainRequest&);
std::string drape_train_text(const DrapeTrainSummary&);
std::string drape_train_json(const DrapeTrainSummary&);

}  // namespace selvedge
