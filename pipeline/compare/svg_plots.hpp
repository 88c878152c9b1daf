#pragma once

#include <string>
#include <vector>

namespace selvedge {

enum class PlotMark { plain, front, unclean, failed };

struct PlotPoint {
  std::string label;
  double x = 0, y = 0;  // a failed one's y may be unknown: it stands at the upper edge
  PlotMark mark = PlotMark::plain;
};

// Points on logarithmic axes, numbered as they come, with the front as a line and the floor, below which nothing is
// told apart, as an area; floor 0: none. Points that are not above zero are left out. Empty without points.
std::string scatter_svg(const std::string& title, const std::string& x_name, const std::string& y_name,
                        const std::vector<PlotPoint>&, double floor);

struct PlotCurve {
  std::string name;
  std::vector<double> y;
};

// Curves over 0, 1, 2, ... with their names below. `logarithmic`: of y + 1. Empty without curves.
std::string curves_svg(const std::string& title, const std::string& x_name, const std::vector<PlotCurve>&,
                       bool logarithmic = false);

// Bars in groups over labels. Empty without labels or bars.
std::string bars_svg(const std::string& title, const std::string& x_name, const std::vector<std::string>& labels,
                     const std::vector<PlotCurve>& bars);

}  // namespace selvedge
