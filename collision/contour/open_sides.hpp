#pragma once

#include <compare>
#include <map>
#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// A component that meets another one, or itself.
struct LayerPair {
  int sheet, component, partner_sheet, partner_component;
  auto operator<=>(const LayerPair&) const = default;
};
LayerPair layers_of(const Contour&, int side);

// Two layers that change places: where one is tucked into the other part of the way round, the contours run from a
// boundary of one to a boundary of the other, enclose nothing, and none becomes shorter by moving.
struct OpenSides {
  std::vector<char> decided;                    // 1 for each contour whose wrong sides are listed here
  std::map<LayerPair, std::vector<int>> wrong;  // vertices of the first component, sorted
};

// Of each vertex that faces the other layer it is known on which side of it that layer is: the nearest point is no
// boundary, and the normals there are near to parallel. Vertices of one side that hang together with a contour are a
// sector; sectors at the same contours belong together, and of the two sides the one with fewer vertices, on both
// layers together, is the wrong one. Contours of different components where one at least parts neither of its sides.
OpenSides open_sides(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>);

}  // namespace selvedge
