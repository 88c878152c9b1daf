#pragma once

#include <vector>

#include "pipeline/formats/look.hpp"
#include "pipeline/hdf5/trajectory.hpp"

namespace selvedge {

// The normals of a look as its surface moves. Corners have one normal where they lie on one vertex of the simulated
// surface and had the same normal in the file: so edges that were smooth or hard stay so, and seams of textures that
// were smooth are.
struct NormalSlots {
  std::vector<int> of_corner;  // empty: the file had no normals
  int count = 0;
};

NormalSlots normal_slots(const Look&);

// Of unit length, a row a slot: the sum over the faces of its corners, by their area. x: of the vertices of the file.
PointsF moved_normals(const Look&, const NormalSlots&, const PointsF& x);

}  // namespace selvedge
