#include <algorithm>

#include "collision/search/bvh_traversal.hpp"

namespace selvedge {

using Pairs = std::vector<std::pair<int, int>>;

std::vector<NodeWork> BvhTraversal::frontier() const {
  constexpr std::size_t enough = 256;
  std::vector<NodeWork> front, next;
  if (within_one || overlap(first.nodes.front().box, second.nodes.front().box)) front.push_back({0, 0});
  for (bool grows = true; grows && front.size() < enough; front.swap(next)) {
    next.clear();
    grows = false;
    for (const NodeWork w : front) {
      if (is_leaf(w)) {
        next.push_back(w);
      } else {
        split(w, next);
        grows = true;
      }
    }
  }
  return front;
}

void self_pairs(const Bvh& tree, Pairs& pairs) {
  pairs.clear();
  PartLists<std::pair<int, int>> parts;
  gather_pairs(BvhTraversal{tree, tree, true}, parts, pairs,
               [](int i, int j, Pairs& found) { found.emplace_back(std::min(i, j), std::max(i, j)); });
}

void cross_pairs(const Bvh& first, const Bvh& second, Pairs& pairs) {
  pairs.clear();
  PartLists<std::pair<int, int>> parts;
  gather_pairs(BvhTraversal{first, second, false}, parts, pairs,
               [](int i, int j, Pairs& found) { found.emplace_back(i, j); });
}

}  // namespace selvedge
