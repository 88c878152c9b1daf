#include <algorithm>

#include "pipeline/plots/page_html.hpp"
#include "pipeline/training/column_plots.hpp"
#include "pipeline/training/training_tables.hpp"

namespace selvedge {
namespace {

constexpr PlotScale log_scale = PlotScale::logarithmic;

// The columns of all terms of the objective whose names end like this.
std::vector<PlottedColumn> terms_with(const std::string& ending) {
  std::vector<PlottedColumn> columns;
  for (const LossRow& row : loss_rows()) {
    std::string name = row.name;
    std::ranges::replace(name, '_', ' ');
    columns.push_back({row.name + ending, name});
  }
  return columns;
}

std::string step_plots(const CsvColumns& steps, bool taught) {
  return column_plot("Terms of the objective, without their signs", {taught ? "J, targets in mm" : "J", log_scale},
                     steps, terms_with("")) +
         column_plot("Share of each term in the gradient", {}, steps, terms_with("_share")) +
         column_plot("Gradient of the weights", {"norm", log_scale}, steps, {{"gradient_norm", "norm"}}) +
         column_plot("Targets that the solver makes", {"targets a second"}, steps,
                     {{"targets_per_second", "targets"}}) +
         column_plot("Learning rate", {}, steps, {{"learning_rate", "learning rate"}});
}

// What is measured now and then, on fixed states and in a roll-out in a training clip.
std::string measure_plots(const CsvColumns& measures) {
  const char *skinned = "from the skinned garment", *optimum = "from the optimum after five frames";
  return column_plot("Fixed states: energy above the optimum", {"J", log_scale}, measures,
                     {{"worn_excess", skinned}, {"minimised_excess", optimum}}) +
         column_plot("Fixed states: part of the gap to the optimum that is closed", {}, measures,
                     {{"worn_closed", skinned}, {"minimised_closed", optimum}}) +
         column_plot("Roll-outs with what runs behind the network: distance from the solver at the end",
                     {"mm", log_scale}, measures, {{"taught_distance", "distance"}}) +
         column_plot("Roll-out: principal strain", {"", log_scale}, measures,
                     {{"strain", "mean"}, {"strain_99", "99th percentile"}}) +
         column_plot("Roll-out: objective", {"J", log_scale}, measures, {{"energy", "objective"}}) +
         column_plot("Roll-out: intersecting pairs", {"pairs", PlotScale::counts}, measures,
                     {{"pairs", "sum of all frames"}, {"pairs_at_end", "last frame"}}) +
         column_plot("Roll-out: volume that cloth encloses with itself", {"cm^3"}, measures, {{"volume", "volume"}}) +
         column_plot("Roll-out: vertices deeper than 1 mm in the body", {}, measures, {{"deep", "share of vertices"}}) +
         column_plot("Roll-out: jitter", {"m/frame^2", log_scale}, measures, {{"jitter", "jitter"}}) +
         column_plot("Roll-out: kinetic energy", {"J", log_scale}, measures, {{"kinetic", "kinetic energy"}});
}

}  // namespace

std::string training_page(const TrainingOptions& options, const std::string& steps_csv,
                          const std::string& measures_csv) {
  return page_head("Training " + options.name) +
         step_plots(CsvColumns(steps_csv), teacher_work(options.objective).targets) +
         measure_plots(CsvColumns(measures_csv)) + page_text("Configuration", training_yaml(options));
}

}  // namespace selvedge
