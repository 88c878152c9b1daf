#pragma once

#include "pipeline/shapes/generate.hpp"

namespace selvedge {

// A strip cut out of a mesh that runs at an angle to it, for checks that must not depend on how cloth is cut.
struct StripShape {
  double length = 1, width = 0.25;  // [m]
  int along = 30;                   // elements: edges span at most about length / along in both directions
  double angle = 0;                 // of the strip to the mesh [rad]
  SheetOptions sheet;
  bool clamp = false;  // one more row of elements before the start
  bool grip = false;   // one more row of elements after the end
};

// The mesh covers [0, length] x [0, width] in u, v, with straight edges, clamp and grip outside. The pattern's lattice
// is turned by the angle; its vertices near an edge of the strip are moved onto it, triangles that cross it are cut
// there, and edges are flipped until all triangles are Delaunay, which leaves the pattern inside as it is. At multiples
// of a right angle it is the plain grid. x = (u, v, 0). Groups: clamp (all vertices at u <= 0), root (those at u = 0),
// tip (u = length), grip (the row behind it), side (v = 0).
Mesh make_strip(const StripShape&);

}  // namespace selvedge
