#include "pipeline/plots/plot_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

double scaled(PlotScale scale, double value) {
  return scale == PlotScale::linear ? value : std::log10(scale == PlotScale::counts ? value + 1 : value);
}

// 1, 2 or 5 times a power of ten, about a sixth of the range.
double round_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 6)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (range / (digit * power) <= 7) return digit * power;
  return 10 * power;
}

std::vector<double> linear_values(double low, double high) {
  const double step = round_step(high - low);
  std::vector<double> values;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) values.push_back(k * step);
  return values;
}

// Powers of ten, with 2 and 5 of each decade where there are few of them.
std::vector<double> decade_values(double low, double high, bool counts) {
  std::vector<double> values;
  if (counts) values.push_back(0);
  const auto first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::ceil(high));
  for (int decade = first; decade <= last; ++decade)
    for (const double digit : {1.0, 2.0, 5.0})
      if (digit == 1 || high - low <= 3) values.push_back(digit * std::pow(10, decade));
  return values;
}

}  // namespace

std::string number_text(double value) {
  const double size = std::abs(value);
  return size > 0 && (size >= 1e5 || size < 1e-3) ? fmt::format("{:.2g}", value) : fmt::format("{:.4g}", value);
}

bool DrawnAxis::has(double value) const {
  return std::isfinite(value) && (scale == PlotScale::linear || value > (scale == PlotScale::counts ? -1 : 0));
}

double DrawnAxis::place(double value) const {
  return begin + (scaled(scale, value) - low) / (high - low) * (end - begin);
}

DrawnAxis axis_for(PlotScale scale, const std::vector<double>& values, double begin, double end) {
  DrawnAxis axis{scale, HUGE_VAL, -HUGE_VAL, begin, end};
  for (const double value : values) {
    if (!axis.has(value)) continue;
    axis.low = std::min(axis.low, scaled(scale, value));
    axis.high = std::max(axis.high, scaled(scale, value));
  }
  if (axis.low > axis.high) return axis;
  const bool from_zero = scale != PlotScale::logarithmic && axis.low >= 0 && axis.low <= axis.high / 2;
  if (from_zero) axis.low = 0;
  double room = 0.06 * (axis.high - axis.low);
  if (room == 0) room = scale == PlotScale::linear && axis.high != 0 ? 0.1 * std::abs(axis.high) : 0.1;
  if (!from_zero) axis.low -= room;
  axis.high += room;
  return axis;
}

std::vector<PlotTick> ticks_of(const DrawnAxis& axis, double apart) {
  std::vector<double> values = axis.scale == PlotScale::linear
                                   ? linear_values(axis.low, axis.high)
                                   : decade_values(axis.low, axis.high, axis.scale == PlotScale::counts);
  const auto outside = [&](double value) {
    const double at = scaled(axis.scale, value);
    return at < axis.low - 1e-9 || at > axis.high + 1e-9;
  };
  std::erase_if(values, outside);
  if (values.size() < 3 && axis.scale == PlotScale::logarithmic) {
    values = linear_values(std::pow(10, axis.low), std::pow(10, axis.high));
    std::erase_if(values, [&](double value) { return !axis.has(value) || outside(value); });
  }
  std::vector<PlotTick> ticks;
  for (const double value : values)
    if (const double at = axis.place(value); ticks.empty() || std::abs(at - ticks.back().at) >= apart)
      ticks.push_back({at, number_text(std::abs(value) < 1e-12 * (axis.high - axis.low) ? 0 : value)});
  return ticks;
}

}  // namespace selvedge
