#pragma once

#include <string>
#include <vector>

namespace selvedge {

// Plots of every page and suite, as SVG that needs no other file: a browser, an editor of vector graphics and LaTeX
// take it. Names and numbers show where the pointer rests; a legend stands below.

enum class PlotScale {
  linear,
  logarithmic,  // values that are not above zero are left out
  counts        // the logarithm of value + 1, for numbers that may be 0
};

struct PlotAxis {
  std::string name;
  PlotScale scale = PlotScale::linear;
};

// A line through its points in their order. Points that are not finite, or not on the scale, are left out.
struct PlotCurve {
  std::string name;
  std::vector<double> x, y;  // as many of both
  bool line = true;          // false: dots alone
};

enum class PlotMark { plain, front, unclean, failed };

struct PlotPoint {
  std::string label;    // stands beside it
  double x = 0, y = 0;  // the y of a failed one may be unknown: it stands at the upper edge
  PlotMark mark = PlotMark::plain;
  std::string about = {};  // shown where the pointer rests; the label if empty
};

struct Plot {
  std::string title = {};
  PlotAxis x = {}, y = {};
  std::vector<PlotCurve> curves = {};
  std::vector<PlotPoint> points = {};
  double floor = 0;  // below it values of y are not told apart: an area; 0: none
};

// The plot, or nothing where no value can be drawn. Points of the mark `front` are joined by a line.
std::string plot_svg(const Plot&);

struct BarPlot {
  struct Bars {
    std::string name;
    std::vector<double> y;  // one for each group, not below zero
  };
  std::string title, x_name;
  std::vector<std::string> groups;  // their labels
  std::vector<Bars> bars;
};

// Bars in groups from zero up, or nothing where there is no group or no bar.
std::string bars_svg(const BarPlot&);

}  // namespace selvedge
