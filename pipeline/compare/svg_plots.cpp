#include "pipeline/compare/svg_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/host/html_text.hpp"

namespace selvedge {
namespace {

constexpr double plot_width = 620, plot_height = 380, plot_left = 70, plot_right = 16, plot_top = 14, plot_bottom = 46;
constexpr std::array plot_colours{"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                  "#8c564b", "#17becf", "#7f7f7f", "#bcbd22", "#e377c2"};

// A range of numbers and where it lies on the page.
struct PlotAxis {
  double low, high;   // of what is shown, logarithms where the axis is logarithmic
  double begin, end;  // on the page
  double place(double value) const { return begin + (value - low) / (high - low) * (end - begin); }
};

PlotAxis axis_of(double low, double high, double begin, double end) {
  const double room = std::max(0.06 * (high - low), 0.05);
  return {low - room, high + room, begin, end};
}

std::string number_text(double value) {
  return value != 0 && (std::abs(value) >= 1e5 || std::abs(value) < 1e-3) ? fmt::format("{:.0e}", value)
                                                                          : fmt::format("{:g}", value);
}

std::string frame_svg(const std::string& title, const std::string& x_name, const std::string& y_name) {
  return fmt::format(
      "<figure><figcaption>{}</figcaption><svg viewBox='0 0 {} {}' width='{}' height='{}'>"
      "<text x='{}' y='{}' text-anchor='middle'>{}</text>"
      "<text transform='translate(14 {}) rotate(-90)' text-anchor='middle'>{}</text>",
      html_text(title), plot_width, plot_height, plot_width, plot_height, (plot_left + plot_width) / 2, plot_height - 6,
      html_text(x_name), plot_height / 2, html_text(y_name));
}

std::string x_line(double place, const std::string& label) {
  return fmt::format(
      "<line class='grid' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}'/><text x='{0:.1f}' y='{3}' "
      "text-anchor='middle'>{4}</text>",
      place, plot_top, plot_height - plot_bottom, plot_height - plot_bottom + 16, label);
}

std::string y_line(double place, const std::string& label) {
  return fmt::format(
      "<line class='grid' x1='{0}' x2='{1}' y1='{2:.1f}' y2='{2:.1f}'/><text x='{3}' y='{4:.1f}' "
      "text-anchor='end'>{5}</text>",
      plot_left, plot_width - plot_right, place, plot_left - 5, place + 4, label);
}

// Lines at 1, 2 and 5 of every decade.
std::string decade_lines(const PlotAxis& axis, bool horizontal) {
  std::string svg;
  for (int decade = -12; decade <= 9; ++decade)
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, decade), at = std::log10(value);
      if (at < axis.low || at > axis.high) continue;
      const std::string label = number_text(value);
      svg += horizontal ? y_line(axis.place(at), label) : x_line(axis.place(at), label);
    }
  return svg;
}

std::string mark_svg(const PlotPoint& point, double x, double y, std::size_t number) {
  const std::string name = fmt::format("<title>{}</title>", html_text(point.label));
  std::string svg;
  if (point.mark == PlotMark::failed)
    svg = fmt::format("<g class='failed'>{0}<path d='M{1:.1f} {2:.1f}l10 10m0 -10l-10 10'/></g>", name, x - 5, y - 5);
  else
    svg = fmt::format("<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='4.5'>{}</circle>",
                      point.mark == PlotMark::front     ? "front"
                      : point.mark == PlotMark::unclean ? "unclean"
                                                        : "plain",
                      x, y, name);
  return svg + fmt::format("<text class='number' x='{:.1f}' y='{:.1f}'>{}</text>", x + 7, y - 5, number);
}

}  // namespace

std::string scatter_svg(const std::string& title, const std::string& x_name, const std::string& y_name,
                        const std::vector<PlotPoint>& points, double floor) {
  double left = HUGE_VAL, right = -HUGE_VAL, low = HUGE_VAL, high = -HUGE_VAL;
  for (const PlotPoint& p : points) {
    if (!(p.x > 0)) continue;
    left = std::min(left, std::log10(p.x));
    right = std::max(right, std::log10(p.x));
    if (!(p.y > 0)) continue;
    low = std::min(low, std::log10(p.y));
    high = std::max(high, std::log10(p.y));
  }
  if (left > right || low > high) return "";
  if (floor > 0) low = std::min(low, std::log10(floor));
  const PlotAxis x = axis_of(left, right, plot_left, plot_width - plot_right);
  const PlotAxis y = axis_of(low, high, plot_height - plot_bottom, plot_top);
  std::string svg = frame_svg(title, x_name, y_name);
  if (floor > 0) {
    const double at = std::min(y.place(std::log10(floor)), plot_height - plot_bottom);
    svg += fmt::format("<rect class='floor' x='{0}' y='{1:.1f}' width='{2}' height='{3:.1f}'/>", plot_left, at,
                       plot_width - plot_right - plot_left, plot_height - plot_bottom - at);
    svg += fmt::format("<text class='number' x='{}' y='{:.1f}' text-anchor='end'>floor</text>",
                       plot_width - plot_right - 4, at + 12);
  }
  svg += decade_lines(x, false) + decade_lines(y, true);
  std::vector<const PlotPoint*> front;
  for (const PlotPoint& p : points)
    if (p.mark == PlotMark::front && p.x > 0 && p.y > 0) front.push_back(&p);
  std::ranges::sort(front, {}, [](const PlotPoint* p) { return p->x; });
  std::string line;
  for (const PlotPoint* p : front)
    line += fmt::format("{:.1f},{:.1f} ", x.place(std::log10(p->x)), y.place(std::log10(p->y)));
  svg += fmt::format("<polyline class='front' points='{}'/>", line);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const PlotPoint& p = points[k];
    const bool at_edge = p.mark == PlotMark::failed && !(p.y > 0);
    if (!(p.x > 0) || (!at_edge && !(p.y > 0))) continue;
    svg += mark_svg(p, x.place(std::log10(p.x)), at_edge ? plot_top + 8 : y.place(std::log10(p.y)), k + 1);
  }
  return svg + "</svg></figure>\n";
}

std::string curves_svg(const std::string& title, const std::string& x_name, const std::vector<PlotCurve>& curves,
                       bool logarithmic) {
  const auto scaled = [&](double v) { return logarithmic ? std::log10(v + 1) : v; };
  double most = 0;
  std::size_t length = 0;
  for (const PlotCurve& curve : curves) {
    length = std::max(length, curve.y.size());
    for (const double v : curve.y)
      if (std::isfinite(v)) most = std::max(most, scaled(v));
  }
  if (length < 2) return "";
  const double last = static_cast<double>(length - 1);
  const PlotAxis x{0, last, plot_left, plot_width - plot_right};
  const PlotAxis y{0, most > 0 ? 1.05 * most : 1, plot_height - plot_bottom, plot_top};
  std::string svg = frame_svg(title, x_name, "");
  for (int k = 0; k <= 5; ++k) {
    const double at = last * k / 5, value = y.high * k / 5;
    svg += x_line(x.place(at), fmt::format("{:.0f}", at));
    svg += y_line(y.place(value), fmt::format("{:.3g}", logarithmic ? std::pow(10, value) - 1 : value));
  }
  std::string names;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::string line;
    for (std::size_t k = 0; k < curves[c].y.size(); ++k)
      if (std::isfinite(curves[c].y[k]))
        line += fmt::format("{:.1f},{:.1f} ", x.place(static_cast<double>(k)), y.place(scaled(curves[c].y[k])));
    const char* colour = plot_colours[c % plot_colours.size()];
    svg += fmt::format("<polyline fill='none' stroke='{}' stroke-width='1.8' points='{}'/>", colour, line);
    names += fmt::format("<span style='color:{}'>&#9632; {}</span> ", colour, html_text(curves[c].name));
  }
  return svg + "</svg><p>" + names + "</p></figure>\n";
}

std::string bars_svg(const std::string& title, const std::string& x_name, const std::vector<std::string>& labels,
                     const std::vector<PlotCurve>& bars) {
  if (labels.empty() || bars.empty()) return "";
  double most = 0;
  for (const PlotCurve& one : bars)
    for (const double v : one.y) most = std::max(most, v);
  const PlotAxis y{0, most > 0 ? 1.05 * most : 1, plot_height - plot_bottom, plot_top};
  std::string svg = frame_svg(title, x_name, "");
  for (int k = 0; k <= 5; ++k) svg += y_line(y.place(y.high * k / 5), fmt::format("{:.3g}", y.high * k / 5));
  const double group = (plot_width - plot_right - plot_left) / static_cast<double>(labels.size());
  const double width = 0.8 * group / static_cast<double>(bars.size());
  std::string names;
  for (std::size_t c = 0; c < bars.size(); ++c) {
    const char* colour = plot_colours[c % plot_colours.size()];
    for (std::size_t k = 0; k < bars[c].y.size(); ++k)
      svg += fmt::format("<rect fill='{}' x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>", colour,
                         plot_left + (static_cast<double>(k) + 0.1) * group + static_cast<double>(c) * width,
                         y.place(bars[c].y[k]), width, y.place(0) - y.place(bars[c].y[k]));
    names += fmt::format("<span style='color:{}'>&#9632; {}</span> ", colour, html_text(bars[c].name));
  }
  for (std::size_t k = 0; k < labels.size(); ++k)
    svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>",
                       plot_left + (static_cast<double>(k) + 0.5) * group, plot_height - plot_bottom + 16,
                       html_text(labels[k]));
  return svg + "</svg><p>" + names + "</p></figure>\n";
}

}  // namespace selvedge
