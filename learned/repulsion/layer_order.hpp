#pragma once

#include <span>
#include <vector>

#include "collision/distance/signed_distance.hpp"

namespace selvedge {

// Cloth that comes out of a body would go through cloth that lies over it, and layers that are both inside would end on
// one surface. Here heights over the body's surface go to heights that keep their order: over each place of the surface
// the deepest vertex goes to `margin`, what lies at `reach` stays, and between them the map is linear. A vertex inside
// counts for places round it, less and less deep, to a distance of `span`: farther than edges are long, or vertices of
// one layer say nothing of the other.
struct LayerOrder {
  double reach = 0;    // from the surface outward, to where cloth goes along [m]; 0: it does not
  double span = 0.04;  // along the surface [m]
  double most = 0.03;  // deeper vertices count as so deep [m]
};

// Heights that vertices at these signed distances go to; those of vertices that stay are their distances. None is lower
// than it was, and of those inside none is under the margin.
std::vector<double> ordered_heights(const std::vector<SignedDistance>&, double margin, const LayerOrder&);

}  // namespace selvedge
