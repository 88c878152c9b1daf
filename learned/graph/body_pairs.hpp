#pragma once

#include <vector>

#include "collision/search/bvh.hpp"
#include "learned/graph/feature_options.hpp"
#include "learned/graph/graph_state.hpp"

namespace selvedge {

// A cloth vertex near the body.
struct BodyPair {
  int cloth = 0;
  int face = -1;   // nearest face of the body; -1 where only vertices were asked for
  int vertex = 0;  // that the edge leads to
};

// Kept between frames. It saves time and does not change what is found.
struct BodySearch {
  KeptBvh body, cloth;  // of the body's vertices or faces, of the cloth's vertices
  std::vector<Box> boxes;
  std::vector<int> last;  // what was nearest each cloth vertex
};

// For each cloth vertex at most one pair, by `body_partner` and `body_radius`, ascending; pairs with an omitted vertex
// among them (parity README, 17 and 23). Where several faces are equally near, the lowest counts.
std::vector<BodyPair> find_body_pairs(const GraphScene&, const FeatureOptions&, const Points& cloth, const Points& body,
                                      BodySearch&);

}  // namespace selvedge
