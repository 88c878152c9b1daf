#pragma once

#include <compare>
#include <map>
#include <span>
#include <vector>

#include "collision/contour/contour.hpp"
#include "collision/contour/segments.hpp"

namespace selvedge {

// A component and the component that it meets, which may be itself.
struct LayerPair {
  int sheet, component, partner_sheet, partner_component;
  auto operator<=>(const LayerPair&) const = default;
};
LayerPair layers_of(const Contour&, int side);

// For two layers that change places, as where one is tucked into the other part of the way round. Their contours run
// from a boundary of one to a boundary of the other, enclose nothing, and none becomes shorter by moving.
struct OpenSides {
  std::vector<char> decided;                    // 1 for each contour whose wrong side is listed here
  std::map<LayerPair, std::vector<int>> wrong;  // vertices of the pair's first component, sorted
};

// Judges pairs of different components with at least one contour that cuts neither of them. For a vertex that faces the
// other layer it is known on which side of the vertex that layer is: its nearest point is not on a boundary, and the
// normals there are nearly parallel. A sector is a connected set of vertices of one side that reaches a contour.
// Sectors at the same contours are compared: the side with fewer vertices, on both layers together, is wrong.
OpenSides open_sides(std::span<const SheetView> sheets, const Segments&, std::span<const Contour>);

}  // namespace selvedge
