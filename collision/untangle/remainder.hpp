#pragma once

#include <span>
#include <string>
#include <vector>

#include "collision/contour/contour_regions.hpp"
#include "collision/untangle/kept_shape.hpp"

namespace selvedge {

// A contour that untangling left, and why.
struct Remainder {
  int pairs = 0;      // of triangles that share no vertex
  double length = 0;  // [m]
  std::string reason;
};

// One for each contour, in their order, and one for the pairs that touch. reach and range: what held the vertices and
// triangles.
std::vector<Remainder> explain_remainders(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>,
                                          const KeptShape&, const std::vector<double>& reach,
                                          const StretchRange& range);

}  // namespace selvedge
