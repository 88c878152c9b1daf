
#include <cmath>

#include "pipeline/host/write_file.hpp"
#include "pipeline/plots/plot.hpp"
#include "pipeline/validate/known_answers.hpp"
#include "pipeline/validate/validate.hpp"

namespace selvedge {
namespace {

// What was measured of a case over one of its parameters.
PlotCurve measured_of(const std::vector<ValidationRow>& rows, const std::string& name, const std::string& parameter) {
  PlotCurve curve{"measured", {}, {}, false};
  for (const ValidationRow& row : rows) {
    if (row.name != name) continue;
    curve.x.push_back(std::stod(row.values.at(parameter)));
    curve.y.push_back(row.measured);
  }
  return curve;
}

PlotCurve master_curve() {
  PlotCurve curve{"expected", {}, {}};
  for (double log = -1; log <= 2.0001; log += 0.05) {
    const double gamma = std::pow(10, log);
    const Cantilever c = elastica(gamma);
    curve.x.push_back(gamma);
    curve.y.push_back(c.H / c.W);
  }
  return curve;
}

}  // namespace

std::string plot_validation(const std::vector<ValidationRow>& rows, const std::filesystem::path& folder) {
  std::string made;
  const auto write = [&](const std::string& name, const PlotCurve& measured, Plot plot) {
    if (measured.x.empty()) return;
    plot.curves.push_back(measured);
    write_file(folder / (name + ".svg"), plot_svg(plot));
    made += (made.empty() ? "plots: " : ", ") + (folder / (name + ".svg")).string();
  };
  constexpr PlotScale log_scale = PlotScale::logarithmic;
  write(
      "cantilever", measured_of(rows, "cantilever", "gamma"),
      {"A cantilever under its own weight", {"rho g L^3 / B", log_scale}, {"H / W", log_scale}, {master_curve()}, {}});
  write("drape", measured_of(rows, "drape", "bending_length"),
        {"A round cloth on a round table", {"bending length [cm]"}, {"drape coefficient"}, {}, {}});
  return made.empty() ? "no plots: no case that has one was run" : made;
}

}  // namespace selvedge
