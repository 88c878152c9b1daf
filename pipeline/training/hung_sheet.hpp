#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A square of cloth of 0.5 m at rest, upright in the plane z = 0, with its upper corners pinned; edges about `edge`
// long [m]. What it hangs from may be anywhere: no body is near.
struct HungSheet {
  Points rest;  // [m]
  Triangles triangles;
  std::vector<int> pins;
};
HungSheet hung_sheet(double edge);

}  // namespace selvedge
