#include "pipeline/training/column_plots.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/plots/page_html.hpp"

namespace selvedge {

std::string column_plot(const std::string& title, const PlotAxis& y, const CsvColumns& table,
                        const std::vector<PlottedColumn>& columns) {
  Plot plot;
  plot.title = title;
  plot.x.name = "steps";
  plot.y = y;
  for (const auto& [column, name] : columns) {
    std::vector<double> values = table[column];
    if (std::ranges::none_of(values, [](double v) { return v != 0; })) continue;
    if (y.scale == PlotScale::logarithmic)
      for (double& value : values) value = std::abs(value);
    plot.curves.push_back({name, table["step"], std::move(values)});
  }
  return page_figure(plot_svg(plot));
}

}  // namespace selvedge
