#include "pipeline/drapes/train_drapes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/floating_point.hpp"
#include "pipeline/drapes/drape_run.hpp"
#include "pipeline/hdf5/neighbour_scale_hdf5.hpp"
#include "pipeline/host/numbers_json.hpp"
#include "pipeline/host/read_file.hpp"
#include "pipeline/host/write_file.hpp"
#include "pipeline/plots/page_html.hpp"
#include "pipeline/processes/together.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/training/column_plots.hpp"

namespace selvedge {
namespace {

// A run in progress.
struct DrapeTraining {
  DrapeRun run;
  StageRun stage;
};

// Returns false if it is stopped.
bool get_distance(DrapeTraining& training) {
  DrapeRun& run = training.run;
  const bool by_network = std::ranges::any_of(run.options.rows, [](const std::string& name) {
    return drape_row(name).neural_layer || drape_row(name).neural_loss;
  });
  if (!by_network) return true;
  run.distance = make_distance_network(run.options, run.lessons);
  if (!run.options.distance.weights.empty())
    run.distance = read_distance_network(run.options.distance.weights, run.distance.inputs());
  else if (!run_stage(training.stage, distance_stage(run.options, run.lessons, run.distance)))
    return false;
  use_network(run.distance, run.lessons);
  return true;
}

bool train_all(DrapeTraining& training) {
  DrapeRun& run = training.run;
  if (!run_stage(training.stage, backbone_stage(run.options, run.lessons, run.backbone))) return false;
  if (!get_distance(training)) return false;
  for (const std::string& name : run.options.rows) {
    const DrapeRow& row = drape_row(name);
    DrapeModel model = run.options.from_scratch ? make_drape_model(run.options, run.lessons) : run.backbone;
    add_scales(row, run.options, run.lessons, model);
    if (!run_stage(training.stage, row_stage(row, run.options, run.lessons, model))) return false;
    if (row.neighbours) write_neighbour_scale(training.stage.folder / "scales.h5", model.neighbours);
    run.rows.emplace_back(&row, std::move(model));
  }
  return true;
}

std::vector<DrapeTableRow> measure_all(DrapeTraining& training) {
  std::vector<DrapeTableRow> table;
  for (const MeasuredMethod& one : measured_methods(training.run)) {
    table.push_back(measure_row(one.method, *one.model, training.run.options, training.run.lessons));
    if (training.stage.request.log) *training.stage.request.log << "measured: " << one.method.name << std::endl;
  }
  return table;
}

// The curves of every stage, the table and the configuration.
std::string drape_page(const DrapeTraining& training, const std::vector<DrapeTableRow>& table) {
  const DrapeRun& run = training.run;
  std::string page = page_head("Training " + run.options.name);
  std::vector<std::string> stages{"backbone", "distance"};
  stages.insert(stages.end(), run.options.rows.begin(), run.options.rows.end());
  for (const std::string& stage : stages) {
    const std::filesystem::path file = training.stage.folder / (stage + ".csv");
    if (!std::filesystem::exists(file)) continue;
    const CsvColumns columns(read_file(file, "table"));
    page += column_plot(stage + ": losses", {"", PlotScale::logarithmic}, columns,
                        {{"reconstruction", "reconstruction"},
                         {"collision", "collision"},
                         {"value", "distance"},
                         {"surface_gradient", "gradient at the surface"},
                         {"eikonal", "eikonal"}});
    page += column_plot(stage + ": errors on what is kept apart", {"mm"}, columns,
                        {{"validation_mm", "vertices, before a layer"},
                         {"error_mm", "distances"},
                         {"near_mm", "distances near the body"}});
    page += column_plot(stage + ": mean scale of pushed vertices", {}, columns, {{"alpha", "scale"}});
  }
  return page + page_text("Drapes to measure on", drape_table_text(table)) +
         page_text("Configuration", drape_training_yaml(run.options));
}

}  // namespace

DrapeTrainSummary train_drapes(const TrainRequest& request) {
  restore_standard_arithmetic();
  const DrapeTrainingOptions options = read_drape_training(request.config, request.overrides);
  const std::filesystem::path folder =
      request.out.empty() ? std::filesystem::path("out") / "training" / options.name : request.out;
  make_folder(folder);
  remove_file(pause_file(folder));
  write_file(folder / "config.yaml", drape_training_yaml(options));
  DrapeLessons lessons = make_drape_lessons(options.drapes, options.validation_paths, options.distance.bones);
  DrapeTraining training{{options, std::move(lessons), {}}, {request, options, folder, 0}};
  DrapeRun& run = training.run;
  run.backbone = make_drape_model(options, run.lessons);
  DrapeTrainSummary summary;
  summary.folder = folder;
  summary.training = static_cast<int>(run.lessons.training.size());
  summary.validation = static_cast<int>(run.lessons.validation.size());
  summary.test = static_cast<int>(run.lessons.test.size());
  for (const DrapePart& part : parts_of(run.backbone)) summary.parameters += parameter_count(*part.network);
  summary.finished = train_all(training);
  summary.seconds = training.stage.seconds;
  remove_file(pause_file(folder));
  if (!summary.finished) return summary;
  summary.table = measure_all(training);
  if (!run.distance.layers.empty()) summary.distance = distance_text(options.distance, run.lessons, run.distance);
  write_file(folder / "table.txt", summary.distance + drape_table_text(summary.table));
  write_file(folder / "table.csv", drape_table_csv(summary.table));
  write_file(folder / "training.html", drape_page(training, summary.table));
  return summary;
}

namespace {

std::string drape_train_text(const DrapeTrainSummary& s) {
  return fmt::format("{:<20}{}\n{:<20}{} to train on, {} to watch, {} to measure on\n{:<20}{}\n{:<20}{}\n",
                     s.finished ? "trained" : "stopped", s.folder.string(), "drapes", s.training, s.validation, s.test,
                     "parameters", s.parameters, "time", duration_text(s.seconds)) +
         (s.table.empty() ? "" : "\n" + s.distance + drape_table_text(s.table));
}

std::string drape_train_json(const DrapeTrainSummary& s) {
  Json rows = Json::array();
  for (const DrapeTableRow& row : s.table)
    rows.push_back({{"row", row.name},
                    {"mpve_mm", row.vertex_error.mean},
                    {"vfcp", row.inside.mean},
                    {"cfmp", row.free.mean},
                    {"laplacian_mm", row.laplacian.mean},
                    {"overshoot_mm", row.overshoot.mean}});
  return json_text({{"folder", s.folder.string()}, {"finished", s.finished}, {"seconds", s.seconds}, {"rows", rows}});
}

}  // namespace

TrainedRun train_as_asked(const TrainRequest& request) {
  return together(request.processes, [&]() -> TrainedRun {
    if (!is_drape_training(request.config)) {
      const TrainSummary summary = train(request);
      return {train_text(summary), train_json(summary), summary.finished};
    }
    if (request.processes)
      throw Error("networks of drapes are trained by one process", request.config.string(), "start it without mpirun");
    const DrapeTrainSummary summary = train_drapes(request);
    return {drape_train_text(summary), drape_train_json(summary), summary.finished};
  });
}

}  // namespace selvedge
