#include <fmt/format.h>

#include "pipeline/host/html_text.hpp"
#include "pipeline/plots/plot_frame.hpp"

namespace selvedge {

std::string bars_svg(const BarPlot& plot) {
  if (plot.groups.empty() || plot.bars.empty()) return "";
  std::vector<double> values{0};
  std::vector<std::string> names;
  for (const BarPlot::Bars& one : plot.bars) {
    values.insert(values.end(), one.y.begin(), one.y.end());
    names.push_back(one.name);
  }
  const DrawnAxis y = axis_for(PlotScale::linear, values, plot_area.bottom, plot_area.top);
  const double group = (plot_area.right - plot_area.left) / static_cast<double>(plot.groups.size());
  const double width = 0.8 * group / static_cast<double>(plot.bars.size());
  std::string svg = y_lines(ticks_of(y, 18));
  for (std::size_t c = 0; c < plot.bars.size(); ++c)
    for (std::size_t k = 0; k < plot.bars[c].y.size(); ++k) {
      const double value = plot.bars[c].y[k];
      if (!y.has(value)) continue;
      svg +=
          fmt::format("<rect fill='{}' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'>{}</rect>", plot_colour(c),
                      plot_area.left + (static_cast<double>(k) + 0.1) * group + static_cast<double>(c) * width,
                      y.place(value), width, y.place(0) - y.place(value),
                      hover_text(fmt::format("{}: {} at {}", plot.bars[c].name, number_text(value), plot.groups[k])));
    }
  for (std::size_t k = 0; k < plot.groups.size(); ++k)
    svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>",
                       plot_area.left + (static_cast<double>(k) + 0.5) * group, plot_area.bottom + 16,
                       html_text(plot.groups[k]));
  return framed_plot(plot.title, plot.x_name, "", svg, names);
}

}  // namespace selvedge
