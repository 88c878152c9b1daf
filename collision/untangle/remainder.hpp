#pragma once

#include <span>
#include <string>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"
#include "collision/untangle/input_shape.hpp"

namespace selvedge {

// A contour that untangling left, and why.
struct Remainder {
  int pairs = 0;      // of crossing triangles that share no vertex
  double length = 0;  // [m]
  std::string reason;
};

// One for each contour, in order, and one for all touching pairs. `reach` [m] and `range` limited the motion of
// vertices and the stretch of triangles.
std::vector<Remainder> explain_remainders(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>,
                                          const InputShape&, const std::vector<double>& reach,
                                          const StretchRange& range);

}  // namespace selvedge
