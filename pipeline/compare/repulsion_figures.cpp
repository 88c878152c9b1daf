#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pipeline/compare/repulsion_report.hpp"
#include "pipeline/plots/page_html.hpp"
#include "pipeline/plots/plot.hpp"

namespace selvedge {
namespace {

constexpr std::size_t energy_bins = 12;

const DrapeTableRow* first_of(const MeasuredDrapes& drapes, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const auto found = std::ranges::find(drapes.rows, name, &DrapeTableRow::name); found != drapes.rows.end())
      return &*found;
  return nullptr;
}

// How many models have an energy in each of the bins from 0 to `most`. [m2] of squared depths.
std::string energy_bars(const std::string& title, const std::vector<const DrapeTableRow*>& rows, double most) {
  std::vector<std::string> labels;
  std::vector<BarPlot::Bars> counts;
  for (std::size_t b = 0; b < energy_bins; ++b)
    labels.push_back(fmt::format("{:.2g}", 1e6 * most * static_cast<double>(b + 1) / energy_bins));
  for (const DrapeTableRow* row : rows) {
    BarPlot::Bars bars{row->name, std::vector<double>(energy_bins, 0)};
    for (const double energy : row->energy_by_drape)
      if (const auto bin = static_cast<std::size_t>(std::ceil(energy / most * energy_bins)); bin <= energy_bins)
        ++bars.y[std::max<std::size_t>(bin, 1) - 1];
    counts.push_back(std::move(bars));
  }
  return page_figure(bars_svg({title, "penetration energy up to [mm2]", labels, counts}));
}

// Figures 6 and 7.
std::string energies(const MeasuredDrapes& drapes) {
  const DrapeTableRow *without = first_of(drapes, {"control", "backbone"}),
                      *with = first_of(drapes, {"hybrid", "approximate", "learned"});
  if (!without || !with || without->energy_by_drape.empty()) return "";
  const double most = std::ranges::max(without->energy_by_drape);
  if (!(most > 0)) return "";
  return energy_bars("Figure 6, " + drapes.name + ": models by penetration energy", {without, with}, most) +
         energy_bars("Figure 7, " + drapes.name + ": the lowest tenth", {without, with}, most / 10);
}

// Figure 8.
std::string scales_by_ratio(const MeasuredDrapes& drapes) {
  constexpr double width = 0.5;
  constexpr std::size_t bins = 10;
  const DrapeTableRow* row = first_of(drapes, {"hybrid", "approximate"});
  if (!row || row->ratio_and_alpha.empty()) return "";
  std::vector<double> sum(bins, 0), count(bins, 0);
  for (const auto& [ratio, alpha] : row->ratio_and_alpha) {
    const auto bin = std::min(static_cast<std::size_t>(ratio / width), bins - 1);
    sum[bin] += alpha;
    ++count[bin];
  }
  std::vector<std::string> labels;
  for (std::size_t b = 0; b < bins; ++b) {
    labels.push_back(b + 1 < bins ? fmt::format("{:.1f}", width * static_cast<double>(b + 1)) : "more");
    sum[b] = count[b] > 0 ? sum[b] / count[b] : 0;
  }
  return page_figure(bars_svg({fmt::format("Figure 8, {}: mean scale of {} pushed vertices ({})", drapes.name,
                                           row->ratio_and_alpha.size(), row->name),
                               "approximate over accurate distance, up to",
                               labels,
                               {{row->name, sum}}}));
}

// Figure 9: five groups of as many test models.
std::string inside_by_distance(const MeasuredDrapes& drapes) {
  constexpr std::size_t groups = 5;
  if (drapes.from_training.size() < groups) return "";
  std::vector<std::size_t> order(drapes.from_training.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return drapes.from_training[k]; });
  std::vector<std::string> labels;
  std::vector<BarPlot::Bars> bars;
  for (const char* name : {"control", "collision_loss", "approximate", "hybrid", "learned"})
    if (const DrapeTableRow* row = first_of(drapes, {name}); row && row->inside_by_drape.size() == order.size())
      bars.push_back({name, std::vector<double>(groups, 0)});
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t begin = g * order.size() / groups, end = (g + 1) * order.size() / groups;
    labels.push_back(fmt::format("{:.1f}", drapes.from_training[order[end - 1]]));
    for (BarPlot::Bars& one : bars)
      for (std::size_t k = begin; k < end; ++k)
        one.y[g] += first_of(drapes, {one.name.c_str()})->inside_by_drape[order[k]] / static_cast<double>(end - begin);
  }
  return page_figure(bars_svg({"Figure 9, " + drapes.name + ": vertices inside [%] by distance to what was trained on",
                               "distance of parameters over their deviations, up to", labels, bars}));
}

}  // namespace

std::string repulsion_figures(const std::vector<MeasuredDrapes>& all) {
  std::string html;
  for (const MeasuredDrapes& one : all)
    if (one.trouble.empty()) html += energies(one) + scales_by_ratio(one) + inside_by_distance(one);
  return html;
}

}  // namespace selvedge
