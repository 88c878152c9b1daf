#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/compare.hpp"
#include "pipeline/host/gnuplot.hpp"

namespace selvedge {
namespace {

// Lines "ms error name" of a scene's rows with one of the marks, the fastest first.
template <class Error>
std::string points_of(const CompareResult& result, const std::string& scene, Error error,
                      std::initializer_list<PlotMark> marks) {
  std::vector<const CompareRow*> kept;
  for (const CompareRow& row : result.rows)
    if (row.scene == scene && std::isfinite(row.ms) && error(row) > 0 &&
        std::ranges::find(marks, mark_of(row, error(row))) != marks.end())
      kept.push_back(&row);
  std::sort(kept.begin(), kept.end(), [](const CompareRow* a, const CompareRow* b) { return a->ms < b->ms; });
  std::string text;
  for (const CompareRow* row : kept) {
    std::string name = row->setting;  // gnuplot reads an underscore as a subscript, and lines one by one
    std::ranges::replace_if(
        name, [](unsigned char c) { return c < ' ' || c == '_' || c == '"' || c == '\\'; }, ' ');
    text += fmt::format("{:.6g} {:.6g} \"{}\"\n", row->ms, error(*row), name);
  }
  return text;
}

// Ticks at 1, 2 and 5 of every decade.
std::string ticks() {
  std::string list;
  for (int decade = -6; decade <= 5; ++decade)
    for (const int digit : {1, 2, 5}) list += fmt::format("{}{}e{}", list.empty() ? "" : ", ", digit, decade);
  return list;
}

std::string axes() {
  return fmt::format(
      "set key outside bottom center horizontal\nset logscale xy\nset autoscale fix\n"
      "set offsets graph 0.03, graph 0.25, graph 0.05, graph 0.05\nset xlabel 'ms a frame'\n"
      "set xtics ({0})\nset ytics ({0})\n",
      ticks());
}

// The rows of a scene as on the page: the front a red line, open circles for what intersects, crosses for what failed.
template <class Error>
std::string scene_plot(const CompareResult& result, const CompareFloor& floor, const std::string& y, Error error,
                       bool with_floor) {
  using enum PlotMark;
  struct Group {
    std::initializer_list<PlotMark> marks;
    const char *name, *style;
  };
  const Group groups[]{{{front}, "front", "linespoints pt 7 ps 0.9 lc rgb '#d62728' title 'efficient front'"},
                       {{plain}, "plain", "points pt 7 ps 0.7 lc 'black' title 'clean'"},
                       {{unclean}, "unclean", "points pt 6 ps 0.8 lc 'black' title 'intersects'"},
                       {{failed}, "failed", "points pt 2 ps 0.8 lc rgb '#d62728' title 'failed'"}};
  const std::string all = points_of(result, floor.scene, error, {front, plain, unclean, failed});
  if (all.empty()) return {};
  std::string data = "$all << EOD\n" + all + "EOD\n", plots;
  if (with_floor && floor.floor() > 0)
    plots = fmt::format("{:.6g} with lines dt 2 lc 'gray' title 'floor', ", floor.floor());
  for (const Group& group : groups)
    if (const std::string points = points_of(result, floor.scene, error, group.marks); !points.empty()) {
      data += fmt::format("${} << EOD\n{}EOD\n", group.name, points);
      plots += fmt::format("${} using 1:2 with {}, ", group.name, group.style);
    }
  return "set ylabel '" + y + "'\n" + data + "plot " + plots +
         "$all using 1:2:3 with labels left offset char 0.7,0 font ',8' notitle\n";
}

}  // namespace

PlotMark mark_of(const CompareRow& row, double error) {
  if (!(error > 0) || !row.trouble.empty()) return PlotMark::failed;
  return row.front ? PlotMark::front : is_clean(row) ? PlotMark::plain : PlotMark::unclean;
}

std::string plot_comparison(const CompareResult& result, const std::filesystem::path& folder) {
  if (!gnuplot_is_there()) return no_gnuplot;
  std::string made;
  const auto plot = [&](const std::string& name, const std::string& body) {
    if (!body.empty() && make_plot(folder, name, axes() + body, "760,520"))
      made += (made.empty() ? "plots: " : ", ") + (folder / (name + ".svg")).string();
  };
  for (const CompareFloor& floor : result.floors) {
    plot(floor.scene + "_temporal",
         scene_plot(
             result, floor, "distance to the reference [m]", [](const CompareRow& row) { return row.temporal; }, true));
    plot(floor.scene + "_algebraic", scene_plot(
                                         result, floor, "algebraic error of a step, of its motion",
                                         [](const CompareRow& row) { return row.algebraic; }, false));
  }
  return made.empty() ? "no plots: there is nothing to show" : made;
}

}  // namespace selvedge
