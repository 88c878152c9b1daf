#pragma once

#include <filesystem>

#include "pipeline/drapes/drape_stages.hpp"
#include "pipeline/drapes/drape_table.hpp"

namespace selvedge {

// The result of a drape training: the drapes and the trained networks.
struct DrapeRun {
  DrapeTrainingOptions options;
  DrapeLessons lessons;
  DrapeModel backbone;
  PlainNetwork distance{};                                     // without layers: none
  std::vector<std::pair<const DrapeRow*, DrapeModel>> rows{};  // in the order of the options
};

const DrapeRow& drape_row(const std::string& name);  // the name must be known (assert)

// The distance network in a stage's file. Throws Error if it reads another number of inputs.
PlainNetwork read_distance_network(const std::filesystem::path&, int inputs);

// Opens the folder of a finished training; its config.yaml names the drapes. Throws Error, also where a stage is not
// finished.
DrapeRun open_drape_run(const std::filesystem::path& folder);

// The rows of a run's table: the backbone, every row, post-processing of the control, and edge passes. They refer to
// the run.
struct MeasuredMethod {
  CollisionMethod method;
  const DrapeModel* model;
};
std::vector<MeasuredMethod> measured_methods(const DrapeRun&);

}  // namespace selvedge
