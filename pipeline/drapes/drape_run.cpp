#include "pipeline/drapes/drape_run.hpp"

#include <algorithm>
#include <cassert>

#include "collision/geometry/error.hpp"
#include "pipeline/drapes/stage_file_hdf5.hpp"

namespace selvedge {
namespace {

StageFile finished_stage(const std::filesystem::path& folder, const std::string& name, const StageOptions& options) {
  const std::filesystem::path file = folder / (name + ".h5");
  StageFile stage = read_stage_file(file);
  if (stage.step < options.steps)
    throw Error("the stage is at step " + std::to_string(stage.step) + " of " + std::to_string(options.steps),
                file.string(), "continue it with `selvedge train --resume`");
  return stage;
}

}  // namespace

const DrapeRow& drape_row(const std::string& name) {
  const auto found = std::ranges::find(known_drape_rows(), name, &DrapeRow::name);
  assert(found != known_drape_rows().end());
  return *found;
}

PlainNetwork read_distance_network(const std::filesystem::path& file, int inputs) {
  const StageFile stage = read_stage_file(file);
  const StagePart* part = stage.find("distance");
  if (!part || part->network.inputs() != inputs)
    throw Error("is not a distance network for these bodies", file.string(),
                "train it with the same `bones`, or leave `distance.weights` out");
  return part->network;
}

DrapeRun open_drape_run(const std::filesystem::path& folder) {
  const DrapeTrainingOptions options = read_drape_training(folder / "config.yaml");
  DrapeRun run{options, make_drape_lessons(options.drapes, options.validation_paths, options.distance.bones), {}};
  run.backbone = blank_drape_model(options, run.lessons);
  restore_model(finished_stage(folder, "backbone", options.backbone.stage), run.backbone);
  const bool by_network = std::ranges::any_of(options.rows, [](const std::string& name) {
    return drape_row(name).neural_layer || drape_row(name).neural_loss;
  });
  if (by_network) {
    std::filesystem::path weights = options.distance.weights;
    if (weights.empty()) weights = folder / "distance.h5";
    run.distance = read_distance_network(weights, make_distance_network(options, run.lessons).inputs());
    use_network(run.distance, run.lessons);
  }
  for (const std::string& name : options.rows) {
    DrapeModel model = blank_drape_model(options, run.lessons);
    add_scales(drape_row(name), options, run.lessons, model);
    restore_model(finished_stage(folder, name, options.from_scratch ? options.backbone.stage : options.fine_tuning),
                  model);
    run.rows.emplace_back(&drape_row(name), std::move(model));
  }
  return run;
}

std::vector<MeasuredMethod> measured_methods(const DrapeRun& run) {
  std::vector<MeasuredMethod> methods{{{"backbone"}, &run.backbone}};
  for (const auto& [row, model] : run.rows) {
    methods.push_back({{row->name, row->layer ? row : nullptr}, &model});
    if (row->name == "control") {
      methods.push_back({{"control, naive", nullptr, PostProcessing::naive}, &model});
      methods.push_back({{"control, naive, edges 1", nullptr, PostProcessing::naive, 1}, &model});
      methods.push_back({{"control, naive, edges 3", nullptr, PostProcessing::naive, 3}, &model});
      methods.push_back({{"control, smooth", nullptr, PostProcessing::smooth}, &model});
      if (!run.distance.layers.empty()) {
        methods.push_back({{"control, naive, approximate", nullptr, PostProcessing::naive, 0, true}, &model});
        methods.push_back({{"control, smooth, approximate", nullptr, PostProcessing::smooth, 0, true}, &model});
      }
    }
    if (row->layer) {
      methods.push_back({{row->name + ", edges 1", row, PostProcessing::nothing, 1}, &model});
      methods.push_back({{row->name + ", edges 3", row, PostProcessing::nothing, 3}, &model});
    }
  }
  return methods;
}

}  // namespace selvedge
