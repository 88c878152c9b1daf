#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/compare/compare.hpp"
#include "pipeline/host/gnuplot.hpp"

namespace selvedge {
namespace {

// Lines "ms error name" of a scene's rows that `keep` keeps, the fastest first.
template <class Error, class Keep>
std::string points_of(const CompareResult& result, const std::string& scene, Error error, Keep keep) {
  std::vector<const CompareRow*> kept;
  for (const CompareRow& row : result.rows)
    if (row.scene == scene && std::isfinite(row.ms) && error(row) > 0 && keep(row)) kept.push_back(&row);
  std::sort(kept.begin(), kept.end(), [](const CompareRow* a, const CompareRow* b) { return a->ms < b->ms; });
  std::string text;
  for (const CompareRow* row : kept) {
    std::string name = row->setting;  // gnuplot reads an underscore as a subscript
    for (std::size_t at = 0; (at = name.find_first_of("_\"", at)) != std::string::npos; ++at) name[at] = ' ';
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

}  // namespace

std::string plot_comparison(const CompareResult& result, const std::filesystem::path& folder) {
  if (!gnuplot_is_there()) return no_gnuplot;
  std::string made;
  const auto plot = [&](const std::string& name, const std::string& body) {
    if (make_plot(folder, name, axes() + body, "760,520"))
      made += (made.empty() ? "plots: " : ", ") + (folder / (name + ".svg")).string();
  };
  for (const CompareFloor& floor : result.floors) {
    const auto temporal = [](const CompareRow& row) { return row.temporal; };
    const std::string all = points_of(result, floor.scene, temporal, [](const CompareRow&) { return true; });
    const std::string front = points_of(result, floor.scene, temporal, [](const CompareRow& row) { return row.front; });
    if (!all.empty())
      plot(floor.scene + "_temporal",
           "set ylabel 'distance to the reference [m]'\n$all << EOD\n" + all + "EOD\n$front << EOD\n" + front +
               fmt::format("EOD\nplot {:.6g} with lines dt 2 lc 'gray' title 'floor', ", floor.floor()) +
               (front.empty() ? ""
                              : "$front using 1:2 with linespoints pt 6 ps 1.6 lc 'red' title 'efficient front', ") +
               "$all using 1:2 with points pt 7 ps 0.6 lc 'black' notitle, "
               "$all using 1:2:3 with labels left offset char 0.7,0 font ',8' notitle\n");
    const std::string one_step = points_of(
        result, floor.scene, [](const CompareRow& row) { return row.algebraic; },
        [](const CompareRow&) { return true; });
    if (!one_step.empty())
      plot(floor.scene + "_algebraic", "set ylabel 'algebraic error of a step, of its motion'\n$all << EOD\n" +
                                           one_step +
                                           "EOD\nplot $all using 1:2 with points pt 7 ps 0.6 lc 'black' notitle, "
                                           "$all using 1:2:3 with labels left offset char 0.7,0 font ',8' notitle\n");
  }
  return made.empty() ? "no plots: there is nothing to show" : made;
}

}  // namespace selvedge
