#pragma once

#include <string>
#include <vector>

#include "pipeline/plots/plot.hpp"

namespace selvedge {

// A range of values and where it lies on the drawing, in pixels.
struct DrawnAxis {
  PlotScale scale = PlotScale::linear;
  double low = 0, high = 1;   // of what is drawn: logarithms where the scale is one
  double begin = 0, end = 1;  // [px]

  bool has(double value) const;      // finite, and on the scale
  double place(double value) const;  // [px]
};

// The axis that shows all values that are on its scale, with some room at its ends. Linear ones begin at zero where
// that takes less than half of them. Without such a value `low` is above `high`.
DrawnAxis axis_for(PlotScale, const std::vector<double>& values, double begin, double end);

struct PlotTick {
  double at;  // [px]
  std::string label;
};

// Ticks at round values, at least `apart` pixels from each other and at most about seven where the scale allows it.
std::vector<PlotTick> ticks_of(const DrawnAxis&, double apart);

// At most four digits; powers of ten where the number is very large or small.
std::string number_text(double value);

}  // namespace selvedge
