#include "pipeline/plots/plot_frame.hpp"

#include <fmt/format.h>

#include <array>

#include "pipeline/host/html_text.hpp"

namespace selvedge {
namespace {

constexpr std::array plot_colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000", "#7f7f7f"};

constexpr const char* plot_style =
    ".selvedge-plot{max-width:100%;height:auto;font:11px system-ui,sans-serif}.selvedge-plot .paper{fill:#fff}"
    ".selvedge-plot text{fill:#222}.selvedge-plot .title{font-size:13px;font-weight:600}"
    ".selvedge-plot .label{font-size:10px;fill:#444}.selvedge-plot .grid{stroke:#e4e4e4}"
    ".selvedge-plot .floor{fill:#f0ead8}.selvedge-plot .line{fill:none;stroke-width:1.8}"
    ".selvedge-plot g:hover>.line{stroke-width:3.2}.selvedge-plot .rest{fill:transparent;stroke:none}"
    ".selvedge-plot .plain{fill:#555}.selvedge-plot .front{fill:#d55e00}"
    ".selvedge-plot .unclean{fill:#fff;stroke:#555;stroke-width:1.5}"
    ".selvedge-plot .front-line{fill:none;stroke:#d55e00;stroke-width:1.5}"
    ".selvedge-plot .failed path{stroke:#b00;stroke-width:2.5}";

constexpr double legend_row = 17;

// The legend's rows below the drawing, and how high they are.
std::pair<std::string, double> legend_svg(const std::vector<std::string>& names) {
  std::string svg;
  double x = plot_area.left, y = plot_height + 8;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double width = 16 + text_width(names[k]) + 14;
    if (x + width > plot_width && x > plot_area.left) {
      x = plot_area.left;
      y += legend_row;
    }
    svg += fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='10' height='10' fill='{}'/><text x='{:.1f}' y='{:.1f}'>{}</text>", x, y - 9,
        plot_colour(k), x + 15, y, html_text(names[k]));
    x += width;
  }
  return {svg, names.empty() ? 0 : y - plot_height + 8};
}

}  // namespace

const char* plot_colour(std::size_t k) { return plot_colours[k % plot_colours.size()]; }

std::string x_lines(const std::vector<PlotTick>& ticks) {
  std::string svg;
  for (const PlotTick& tick : ticks)
    svg += fmt::format(
        "<line class='grid' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}'/><text x='{0:.1f}' y='{3}' "
        "text-anchor='middle'>{4}</text>",
        tick.at, plot_area.top, plot_area.bottom, plot_area.bottom + 16, html_text(tick.label));
  return svg;
}

std::string y_lines(const std::vector<PlotTick>& ticks) {
  std::string svg;
  for (const PlotTick& tick : ticks)
    svg += fmt::format(
        "<line class='grid' x1='{0}' x2='{1}' y1='{2:.1f}' y2='{2:.1f}'/><text x='{3}' y='{4:.1f}' "
        "text-anchor='end'>{5}</text>",
        plot_area.left, plot_area.right, tick.at, plot_area.left - 5, tick.at + 4, html_text(tick.label));
  return svg;
}

std::string hover_text(const std::string& text) { return "<title>" + html_text(text) + "</title>"; }

std::string framed_plot(const std::string& title, const std::string& x_name, const std::string& y_name,
                        const std::string& inner, const std::vector<std::string>& legend) {
  const auto [names, names_height] = legend_svg(legend);
  const double height = plot_height + names_height, middle = (plot_area.left + plot_area.right) / 2;
  return fmt::format(
      "<svg class='selvedge-plot' xmlns='http://www.w3.org/2000/svg' role='img' aria-label='{0}' viewBox='0 0 {1} {2}' "
      "width='{1}' height='{2}'><style>{3}</style><rect class='paper' width='{1}' height='{2}'/>"
      "<text class='title' x='{4}' y='18' text-anchor='middle'>{0}</text>"
      "<text x='{4}' y='{5}' text-anchor='middle'>{6}</text>"
      "<text transform='translate(14 {7}) rotate(-90)' text-anchor='middle'>{8}</text>{9}{10}</svg>\n",
      html_text(title), plot_width, height, plot_style, middle, plot_area.bottom + 36, html_text(x_name),
      (plot_area.top + plot_area.bottom) / 2, html_text(y_name), inner, names);
}

}  // namespace selvedge
