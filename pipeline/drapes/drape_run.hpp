#pragma once

#include <filesystem>

#include "pipeline/drapes/drape_stages.hpp"
#include "pipeline/drapes/drape_table.hpp"

namespace selvedge {

// What a training of drapes has made: its networks as they were trained, and the drapes.
struct DrapeRun {
  DrapeTrainingOptions options;
  DrapeLessons lessons;
  DrapeModel backbone;
  PlainNetwork distance{};                                     // without layers: there is none
  std::vector<std::pair<const DrapeRow*, DrapeModel>> rows{};  // in the order of the options
};

const DrapeRow& drape_row(const std::string& name);  // a known one (assert)

// The network of distances in a stage's file, where it reads as many inputs as it must. Throws Error.
PlainNetwork read_distance_network(const std::filesystem::path&, int inputs);

// The folder of a training that has ended; the drapes are where its config.yaml says. Throws Error, also where a stage
// has not come to its end.
DrapeRun open_drape_run(const std::filesystem::path& folder);

// The rows of a run's table: the backbone, every row, post-processing of the control, and edge passes. Points into the
// run.
struct MeasuredMethod {
  CollisionMethod method;
  const DrapeModel* model;
};
std::vector<MeasuredMethod> measured_methods(const DrapeRun&);

}  // namespace selvedge
