#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "pipeline/training/random_stream.hpp"

namespace selvedge {

// A square of cloth of 0.5 m at rest, upright in the plane z = 0, with its upper edge pinned. Edges have a length of
// about `edge` [m].
struct HungSheet {
  Points rest;  // [m]
  Triangles triangles;
  std::vector<int> pins;
};
HungSheet hung_sheet(double edge);

// The sheet with one of its lower corners folded up and through it: turned by 9 to 20 degrees more than half a turn
// about a line 14 to 24 cm from the corner. Corner, side, line, angle and the fold's radius of 4 to 12 mm are random.
// Two boundaries close its contour, so that shortening the contour takes the corner out.
Points folded(const Points& flat, RandomStream&);

}  // namespace selvedge
