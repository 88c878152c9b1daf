#pragma once

#include <vector>

#include "collision/geometry/cell_grid.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge {

// What each vertex of a worn surface stands on: the vertex of the body that is nearest where both are as made.
struct Footing {
  std::vector<int> foot;     // of the body's vertices
  std::vector<double> part;  // of the gap before the foot, from which on a vertex that is farther out is squeezed
};

// A body in a pose, as all that is worn on it looks it up.
struct PosedSkin {
  PosedSkin(const Surface& body, const Points& posed);

  Points x;  // [m]
  CellGrid grid;
  Points x_in_order, normals_in_order;  // in the grid's order
};

// x is worn by the body at rest [m]; the body's own parts are apart there.
Footing footing_of(const Points& x, const PosedSkin& rest);

// That of some vertices; none of none.
Footing footing_of(const Footing&, const std::vector<int>& vertices);

// Where x, worn by the body in that pose, would reach into another part of the body that has come near, or past the
// middle of the gap between, it is squeezed: drawn to its feet, as far as leaves the order of layers and both sides
// their half. What is farther from the body than 6 cm stays, and so does all where no part is nearer than it was at
// rest.
Points squeezed(const Footing&, const PosedSkin&, const Points& x);

}  // namespace selvedge
