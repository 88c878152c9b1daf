#include <fmt/format.h>

#include <algorithm>

#include "pipeline/host/html_text.hpp"
#include "pipeline/plots/plot_frame.hpp"

namespace selvedge {
namespace {

constexpr std::size_t few_values = 40, most_rests = 160;

struct DrawnAxes {
  DrawnAxis x, y;
  bool have(double at, double value) const { return x.has(at) && y.has(value); }
};

// Points of the curve where the pointer rests: all are dots where there are few, else some can only be felt.
std::string values_svg(const PlotCurve& curve, const DrawnAxes& axes, const char* colour) {
  std::string svg;
  const std::size_t count = std::min(curve.x.size(), curve.y.size());
  const bool dots = !curve.line || count <= few_values;
  const std::size_t stride = dots ? 1 : count / most_rests + 1;
  for (std::size_t k = 0; k < count; k += stride) {
    if (!axes.have(curve.x[k], curve.y[k])) continue;
    svg += fmt::format(
        "<circle {} cx='{:.1f}' cy='{:.1f}' r='{}'>{}</circle>",
        dots ? fmt::format("fill='{}'", colour) : "class='rest'", axes.x.place(curve.x[k]), axes.y.place(curve.y[k]),
        dots ? 3 : 6,
        hover_text(fmt::format("{}: {} at {}", curve.name, number_text(curve.y[k]), number_text(curve.x[k]))));
  }
  return svg;
}

std::string curve_svg(const PlotCurve& curve, const DrawnAxes& axes, const char* colour) {
  std::string line;
  for (std::size_t k = 0; k < std::min(curve.x.size(), curve.y.size()); ++k)
    if (axes.have(curve.x[k], curve.y[k]))
      line += fmt::format("{:.1f},{:.1f} ", axes.x.place(curve.x[k]), axes.y.place(curve.y[k]));
  std::string svg = "<g>";
  if (curve.line) svg += fmt::format("<polyline class='line' stroke='{}' points='{}'/>", colour, line);
  return svg + values_svg(curve, axes, colour) + "</g>";
}

// Where a point is drawn. A failed one without a value stands at the upper edge.
PlotLabel drawn_point(const PlotPoint& point, const DrawnAxes& axes) {
  return {point.label, axes.x.place(point.x), axes.y.has(point.y) ? axes.y.place(point.y) : plot_area.top + 8};
}

bool is_drawn(const PlotPoint& point, const DrawnAxes& axes) {
  return axes.x.has(point.x) && (axes.y.has(point.y) || point.mark == PlotMark::failed);
}

std::string mark_svg(const PlotPoint& point, const PlotLabel& at) {
  const std::string name = hover_text(point.about.empty() ? point.label : point.about);
  if (point.mark == PlotMark::failed)
    return fmt::format("<g class='failed'>{}<path d='M{:.1f} {:.1f}l10 10m0 -10l-10 10'/></g>", name, at.x - 5,
                       at.y - 5);
  return fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='4.5'>{}</circle>",
                     point.mark == PlotMark::front     ? "front"
                     : point.mark == PlotMark::unclean ? "unclean"
                                                       : "plain",
                     at.x, at.y, name);
}

// Through the points of the front, from left to right.
std::string front_svg(std::vector<PlotPoint> points, const DrawnAxes& axes) {
  std::erase_if(points, [&](const PlotPoint& p) { return p.mark != PlotMark::front || !axes.have(p.x, p.y); });
  std::ranges::sort(points, {}, &PlotPoint::x);
  std::string line;
  for (const PlotPoint& p : points) line += fmt::format("{:.1f},{:.1f} ", axes.x.place(p.x), axes.y.place(p.y));
  return line.empty() ? line : fmt::format("<polyline class='front-line' points='{}'/>", line);
}

std::string points_svg(std::vector<PlotPoint> points, const DrawnAxes& axes) {
  std::erase_if(points, [&](const PlotPoint& p) { return !is_drawn(p, axes); });
  std::vector<PlotLabel> labels;
  for (const PlotPoint& point : points) labels.push_back(drawn_point(point, axes));
  std::string svg = front_svg(points, axes);
  for (std::size_t k = 0; k < points.size(); ++k) svg += mark_svg(points[k], labels[k]);
  for (const PlotLabel& label : place_labels(labels, plot_area))
    svg += fmt::format("<text class='label' x='{:.1f}' y='{:.1f}'>{}</text>", label.x, label.y, html_text(label.text));
  return svg;
}

std::string floor_svg(double floor, const DrawnAxes& axes) {
  if (!(floor > 0)) return "";
  const double at = std::clamp(axes.y.place(floor), plot_area.top, plot_area.bottom);
  return fmt::format(
      "<rect class='floor' x='{0}' y='{1:.1f}' width='{2}' height='{3:.1f}'/>"
      "<text class='label' x='{4}' y='{5:.1f}' text-anchor='end'>floor</text>",
      plot_area.left, at, plot_area.right - plot_area.left, plot_area.bottom - at, plot_area.right - 4, at + 12);
}

// Axes that show all that can be drawn.
DrawnAxes axes_of(const Plot& plot) {
  std::vector<double> x, y{};
  for (const PlotCurve& curve : plot.curves) {
    x.insert(x.end(), curve.x.begin(), curve.x.end());
    y.insert(y.end(), curve.y.begin(), curve.y.end());
  }
  for (const PlotPoint& point : plot.points) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  DrawnAxes axes{axis_for(plot.x.scale, x, plot_area.left, plot_area.right),
                 axis_for(plot.y.scale, y, plot_area.bottom, plot_area.top)};
  if (axes.y.low <= axes.y.high && plot.floor > 0) {
    y.push_back(plot.floor);
    axes.y = axis_for(plot.y.scale, y, plot_area.bottom, plot_area.top);
  }
  return axes;
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  const DrawnAxes axes = axes_of(plot);
  if (axes.x.low > axes.x.high || axes.y.low > axes.y.high) return "";
  std::string svg = floor_svg(plot.floor, axes) + x_lines(ticks_of(axes.x, 46)) + y_lines(ticks_of(axes.y, 18));
  std::vector<std::string> names;
  for (std::size_t k = 0; k < plot.curves.size(); ++k) {
    names.push_back(plot.curves[k].name);
    svg += curve_svg(plot.curves[k], axes, plot_colour(k));
  }
  return framed_plot(plot.title, plot.x.name, plot.y.name, svg + points_svg(plot.points, axes), names);
}

}  // namespace selvedge
