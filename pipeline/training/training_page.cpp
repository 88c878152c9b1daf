#include <cmath>

#include "pipeline/training/csv_charts.hpp"
#include "pipeline/training/training_tables.hpp"

namespace selvedge {
namespace {

// Gravity is negative. Without its sign it can be drawn on a logarithmic axis.
std::vector<Curve> sizes(std::vector<Curve> curves) {
  for (Curve& curve : curves)
    for (double& y : curve.y) y = std::abs(y);
  return curves;
}

}  // namespace

std::string training_page(const TrainingOptions& options, const std::string& steps_csv,
                          const std::string& measures_csv) {
  const CsvColumns steps(steps_csv), measures(measures_csv);
  std::vector<std::string> terms, shares;
  for (const LossRow& row : loss_rows()) {
    terms.emplace_back(row.name);
    shares.push_back(terms.back() + "_share");
  }
  const std::vector<double>&at = steps["step"], &measured = measures["step"];
  std::string page = page_head("Training " + options.name);
  page += chart("Terms of the objective without sign [J]", at, sizes(columns_of(steps, terms)), true);
  page += chart("Share of the gradient", at, columns_of(steps, shares), false);
  page += chart("Norm of the weights' gradient", at, columns_of(steps, {"gradient_norm"}), true);
  page += chart("Targets a second that the solver makes", at, columns_of(steps, {"targets_per_second"}), false);
  page += chart("Learning rate", at, columns_of(steps, {"learning_rate"}), false);
  page += chart("Excess over the optimum on fixed states [J]", measured,
                columns_of(measures, {"worn_excess", "minimised_excess"}), true);
  page +=
      chart("Gap closed on fixed states", measured, columns_of(measures, {"worn_closed", "minimised_closed"}), false);
  page += chart("Roll-outs with what runs behind the network: distance from the solver at the end [mm]", measured,
                columns_of(measures, {"taught_distance"}), true);
  page += chart("Roll-out on a training clip: strain", measured, columns_of(measures, {"strain", "strain_99"}), true);
  page += chart("Roll-out: objective [J]", measured, columns_of(measures, {"energy"}), true);
  page += chart("Roll-out: intersecting pairs", measured, columns_of(measures, {"pairs", "pairs_at_end"}), false);
  page += chart("Roll-out: volume that cloth encloses with itself [cm^3]", measured, columns_of(measures, {"volume"}),
                false);
  page += chart("Roll-out: vertices deeper than 1 mm in the body", measured, columns_of(measures, {"deep"}), false);
  page += chart("Roll-out: jitter [m/frame^2]", measured, columns_of(measures, {"jitter"}), true);
  page += chart("Roll-out: kinetic energy [J]", measured, columns_of(measures, {"kinetic"}), true);
  return page + page_text("Configuration", training_yaml(options));
}

}  // namespace selvedge
