#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/compare/compare_result.hpp"
#include "pipeline/plots/plot.hpp"

namespace selvedge {

// How a row with this error is drawn.
PlotMark mark_of(const CompareRow&, double error);

struct ComparedPoint {
  const CompareRow* row;
  std::string label;
  double error;
};

// Error over the time of a frame, both on logarithmic axes, with the front and the floor (0: none).
Plot error_plot(const std::string& title, const std::string& y_name, double floor, const std::vector<ComparedPoint>&);

// Writes SCENE_temporal.svg and SCENE_algebraic.svg of each scene that has such errors. Returns a line that says which.
std::string plot_comparison(const CompareResult&, const std::filesystem::path& folder);

}  // namespace selvedge
