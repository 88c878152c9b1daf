#pragma once

#include <vector>

#include "collision/distance/signed_distance.hpp"

namespace selvedge {

// Keeps the order of cloth layers when vertices are pushed out of a body. Without it, cloth from inside would pass
// through the cloth over it, and two layers that are both inside would end on one surface. Heights over the body's
// surface are mapped so that their order stays. Over each place of the surface the deepest vertex goes to `margin`, a
// vertex at height `reach` stays, and the map between them is linear. A vertex inside counts for the places round it up
// to a distance of `span`, with a depth that decreases with the distance. `span` must be longer than edges, or vertices
// of one layer do not see those of the other.
struct LayerOrder {
  double reach = 0;    // height up to which cloth moves with pushed vertices [m]; 0: none does
  double span = 0.04;  // along the surface [m]
  double most = 0.03;  // a deeper vertex counts with this depth [m]
};

// The new height of each vertex at these signed distances. Vertices that stay keep their distance. No height decreases,
// and no vertex inside ends below the margin.
std::vector<double> ordered_heights(const std::vector<SignedDistance>&, double margin, const LayerOrder&);

}  // namespace selvedge
