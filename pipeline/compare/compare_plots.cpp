#include "pipeline/compare/compare_plots.hpp"

#include <fmt/format.h>

#include "pipeline/host/write_file.hpp"

namespace selvedge {
namespace {

// What is plotted of a row, and in which unit.
struct PlottedError {
  const char *name, *title, *unit;
  double factor;
  bool has_floor;
};
constexpr PlottedError plotted_errors[]{{"temporal", "distance to the temporal reference", "RMS [mm]", 1000, true},
                                        {"algebraic", "algebraic error of a step", "part of its motion", 1, false}};

double error_of(const CompareRow& row, const PlottedError& error) {
  return error.has_floor ? row.temporal : row.algebraic;
}

}  // namespace

PlotMark mark_of(const CompareRow& row, double error) {
  if (!(error > 0) || !row.trouble.empty()) return PlotMark::failed;
  return row.front ? PlotMark::front : is_clean(row) ? PlotMark::plain : PlotMark::unclean;
}

Plot error_plot(const std::string& title, const std::string& y_name, double floor,
                const std::vector<ComparedPoint>& rows) {
  Plot plot;
  plot.title = title;
  plot.x = {"ms a frame", PlotScale::logarithmic};
  plot.y = {y_name, PlotScale::logarithmic};
  plot.floor = floor;
  for (const auto& [row, label, error] : rows) {
    const std::string about = fmt::format("{}: {:.3g} at {:.3g} ms", row->setting, error, row->ms);
    plot.points.push_back({label, row->ms, error, mark_of(*row, error), about});
  }
  return plot;
}

std::string plot_comparison(const CompareResult& result, const std::filesystem::path& folder) {
  std::string made;
  for (const CompareFloor& floor : result.floors)
    for (const PlottedError& error : plotted_errors) {
      std::vector<ComparedPoint> points;
      for (const CompareRow& row : result.rows)
        if (row.scene == floor.scene) points.push_back({&row, row.setting, error.factor * error_of(row, error)});
      const std::string svg = plot_svg(error_plot(floor.scene + ": " + error.title, error.unit,
                                                  error.has_floor ? error.factor * floor.floor() : 0, points));
      if (svg.empty()) continue;
      const std::filesystem::path file = folder / fmt::format("{}_{}.svg", floor.scene, error.name);
      write_file(file, svg);
      made += (made.empty() ? "plots: " : ", ") + file.string();
    }
  return made.empty() ? "no plots: there is nothing to show" : made;
}

}  // namespace selvedge
