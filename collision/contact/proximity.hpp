#pragma once

#include <span>

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// A pair closer than its rest gap, linearised at the present positions: gap(x) = normal . sum w_i x_i.
struct Proximity {
  NodePair pair;
  Eigen::Vector4d weights;
  Vec3 normal;          // from the second primitive toward the first
  double gap = 0;       // [m], > 0
  double rest_gap = 0;  // distance that contact aims for [m]
};

// Proximities among `candidates` at positions x. Of the faces near a vertex only the closest on each side counts, and
// likewise of the edges near an edge, so that one contact gets one force. Pairs of one cloth that are close in the rest
// shape have a rest gap of at most 0.7 of their rest distance. Sorted by pair, whatever the order of the candidates.
std::vector<Proximity> find_proximities(const ContactWorld&, std::span<const NodePair> candidates, const Points& x,
                                        double thickness);

}  // namespace selvedge
