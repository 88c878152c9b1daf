#pragma once

#include <vector>

#include "collision/geometry/cell_grid.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge {

// For each vertex of a worn surface its foot: the vertex of the body that is nearest in the rest pose.
struct Footing {
  std::vector<int> foot;     // of the body's vertices
  std::vector<double> part;  // share of the gap above the foot beyond which a vertex is squeezed
};

// A body in a pose, with a grid for searches from garments.
struct PosedSkin {
  PosedSkin(const Surface& body, const Points& posed);

  Points x;  // [m]
  CellGrid grid;
  Points x_in_order, normals_in_order;  // in the grid's order
};

// The footing of a surface x that is worn by the body at rest [m]. The parts of the body must be apart there.
Footing footing_of(const Points& x, const PosedSkin& rest);

// The footing of some of the vertices; empty if the given one is.
Footing footing_of(const Footing&, const std::vector<int>& vertices);

// Squeezes a surface x that the body wears in this pose. A vertex is moved toward its foot if it would be inside
// another part of the body that has come near, or beyond the middle of the gap to it. Layers keep their order, and each
// side keeps its half of the gap. Vertices farther than 6 cm from the body stay. Nothing moves unless a part of the
// body is nearer than at rest.
Points squeezed(const Footing&, const PosedSkin&, const Points& x);

}  // namespace selvedge
