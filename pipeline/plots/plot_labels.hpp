#pragma once

#include <string>
#include <vector>

namespace selvedge {

// A label and the point that it belongs to. [px]
struct PlotLabel {
  std::string text;
  double x = 0, y = 0;
};

// A rectangle of the drawing. [px]
struct PlotArea {
  double left = 0, top = 0, right = 0, bottom = 0;
};

// Where labels stand, as the left end of their baselines: beside their points, inside of `inside`, and each on the
// place of eight round its point where it covers least of the points and of the labels before it.
std::vector<PlotLabel> place_labels(const std::vector<PlotLabel>&, const PlotArea& inside);

// About how wide a text is in the plots' letters. [px]
double text_width(const std::string&);

}  // namespace selvedge
