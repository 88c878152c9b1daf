#pragma once

#include <vector>

#include "collision/search/bvh.hpp"
#include "learned/graph/feature_options.hpp"
#include "learned/graph/graph_state.hpp"

namespace selvedge {

// A cloth vertex near the body.
struct BodyPair {
  int cloth = 0;
  int face = -1;   // nearest face of the body; -1 if only vertices were searched
  int vertex = 0;  // vertex of the body that the edge leads to
};

// Memory between frames. It saves time and does not change the result.
struct BodySearch {
  KeptBvh body, cloth;  // trees of the body's vertices or faces, and of the cloth's vertices
  std::vector<Box> boxes;
  std::vector<int> last;  // nearest vertex or face of each cloth vertex
};

// At most one pair per cloth vertex, by `body_partner` and `body_radius`, ascending. Pairs with an omitted vertex are
// included (parity README, 17 and 23). The lowest of several nearest faces counts.
std::vector<BodyPair> find_body_pairs(const GraphScene&, const FeatureOptions&, const Points& cloth, const Points& body,
                                      BodySearch&);

}  // namespace selvedge
