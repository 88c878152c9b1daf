#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A square of cloth of 0.5 m at rest, upright in the plane z = 0, with its upper edge pinned; edges about `edge` long
// [m].
struct HungSheet {
  Points rest;  // [m]
  Triangles triangles;
  std::vector<int> pins;
};
HungSheet hung_sheet(double edge);

}  // namespace selvedge
