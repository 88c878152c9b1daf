#include "pipeline/training/csv_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "pipeline/host/html_text.hpp"

namespace selvedge {
namespace {

constexpr std::array colours{"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b", "#17becf", "#7f7f7f"};

}  // namespace

CsvColumns::CsvColumns(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line, word;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    for (std::size_t k = 0; k < columns.size() && std::getline(words, word, ','); ++k)
      columns[k].push_back(std::strtod(word.c_str(), nullptr));
    if (!columns.empty()) continue;
    while (std::getline(words, word, ',')) names.push_back(word);
    columns.resize(names.size());
  }
}

const std::vector<double>& CsvColumns::operator[](const std::string& name) const {
  static const std::vector<double> none;
  const auto at = std::ranges::find(names, name);
  return at == names.end() ? none : columns[static_cast<std::size_t>(at - names.begin())];
}

std::string chart(const std::string& title, const std::vector<double>& x, const std::vector<Curve>& curves,
                  bool logarithmic) {
  constexpr double width = 560, height = 260, left = 64, bottom = 24, top = 8;
  const auto scaled = [&](double y) { return logarithmic ? std::log10(y) : y; };
  const auto usable = [&](double y) { return std::isfinite(y) && (!logarithmic || y > 0); };
  double low = 1e300, high = -1e300, last = 1;
  for (const double step : x) last = std::max(last, step);
  for (const Curve& curve : curves)
    for (const double y : curve.y)
      if (usable(y)) {
        low = std::min(low, scaled(y));
        high = std::max(high, scaled(y));
      }
  if (low > high) return "";
  if (high - low < 1e-12) high = low + 1;
  std::string svg =
      fmt::format("<figure><figcaption>{}</figcaption><svg width='{}' height='{}'>", html_text(title), width, height);
  const auto place_y = [&](double y) { return height - bottom - (y - low) / (high - low) * (height - bottom - top); };
  for (int k = 0; k <= 4; ++k) {
    const double y = low + (high - low) * k / 4;
    svg += fmt::format(
        "<line x1='{0}' x2='{1}' y1='{2:.1f}' y2='{2:.1f}' stroke='#ddd'/><text x='4' y='{3:.1f}'>{4:.3g}</text>", left,
        width, place_y(y), place_y(y) + 4, logarithmic ? std::pow(10, y) : y);
  }
  svg += fmt::format("<text x='{}' y='{}'>0</text><text x='{}' y='{}' text-anchor='end'>{:.0f} steps</text>", left,
                     height - 6, width, height - 6, last);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::string points;
    for (std::size_t k = 0; k < std::min(x.size(), curves[c].y.size()); ++k)
      if (usable(curves[c].y[k]))
        points += fmt::format("{:.1f},{:.1f} ", left + x[k] / last * (width - left), place_y(scaled(curves[c].y[k])));
    svg += fmt::format("<polyline fill='none' stroke='{}' stroke-width='1.5' points='{}'/>",
                       colours[c % colours.size()], points);
  }
  svg += "</svg><p>";
  for (std::size_t c = 0; c < curves.size(); ++c)
    svg += fmt::format("<span style='color:{}'>{}</span> ", colours[c % colours.size()], html_text(curves[c].name));
  return svg + "</p></figure>\n";
}

std::vector<Curve> columns_of(const CsvColumns& table, const std::vector<std::string>& names) {
  std::vector<Curve> curves;
  for (const std::string& name : names)
    if (const std::vector<double>& y = table[name]; std::ranges::any_of(y, [](double v) { return v != 0; }))
      curves.push_back({name, y});
  return curves;
}

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!doctype html><meta charset='utf-8'><title>{0}</title>"
      "<style>body{{font:13px sans-serif;margin:16px}}figure{{display:inline-block;margin:8px}}"
      "svg text{{font-size:10px}}figcaption{{font-weight:bold}}pre{{background:#f4f4f4;padding:8px}}</style>"
      "<h1>{0}</h1>\n",
      html_text(title));
}

std::string page_text(const std::string& heading, const std::string& text) {
  return "<h2>" + html_text(heading) + "</h2><pre>" + html_text(text) + "</pre>\n";
}

}  // namespace selvedge
