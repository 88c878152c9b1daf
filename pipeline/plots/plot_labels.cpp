#include "pipeline/plots/plot_labels.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

constexpr double letter_width = 5.6, letter_height = 10, mark_radius = 5;

double common_area(const PlotArea& a, const PlotArea& b) {
  const double width = std::min(a.right, b.right) - std::max(a.left, b.left);
  const double height = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
  return width > 0 && height > 0 ? width * height : 0;
}

PlotArea mark_area(const PlotLabel& at) {
  return {at.x - mark_radius, at.y - mark_radius, at.x + mark_radius, at.y + mark_radius};
}

// The label's area on place `k` of eight, from the right upper one on.
PlotArea label_area(const PlotLabel& label, int k) {
  constexpr double away = mark_radius + 2;
  constexpr int sides[8][2]{{1, -1}, {1, 1}, {-1, -1}, {-1, 1}, {1, 0}, {-1, 0}, {0, -1}, {0, 1}};
  const double width = text_width(label.text);
  const auto [side, up] = sides[k];
  const double left = label.x + (side > 0 ? away : side < 0 ? -away - width : -width / 2);
  const double top = label.y + (up > 0 ? away / 2 : up < 0 ? -away / 2 - letter_height : -letter_height / 2);
  return {left, top, left + width, top + letter_height};
}

}  // namespace

double text_width(const std::string& text) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  return letter_width * static_cast<double>(std::ranges::count_if(text, begins));
}

std::vector<PlotLabel> place_labels(const std::vector<PlotLabel>& labels, const PlotArea& inside) {
  std::vector<PlotArea> taken;
  for (const PlotLabel& label : labels) taken.push_back(mark_area(label));
  std::vector<PlotLabel> placed;
  for (const PlotLabel& label : labels) {
    PlotArea best;
    double least = HUGE_VAL;
    for (int k = 0; k < 8; ++k) {
      const PlotArea area = label_area(label, k);
      const double size = (area.right - area.left) * (area.bottom - area.top);
      double covered = 4 * (size - common_area(area, inside));  // what lies outside cannot be read
      for (const PlotArea& other : taken) covered += common_area(area, other);
      if (covered >= least) continue;
      least = covered;
      best = area;
    }
    taken.push_back(best);
    placed.push_back({label.text, best.left, best.bottom - 1});
  }
  return placed;
}

}  // namespace selvedge
