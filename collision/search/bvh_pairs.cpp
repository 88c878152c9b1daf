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
  const BvhTraversal traversal{tree, tree, true};
  gather(traversal, parts, pairs, [&](NodeWork w, Pairs& found) {
    const Bvh::Leaf &a = traversal.leaf_a(w), &b = traversal.leaf_b(w);
    const auto add = [&](int i, int j) {
      found.emplace_back(std::min(a.item[i], b.item[j]), std::max(a.item[i], b.item[j]));
    };
    return w.a == w.b ? for_each_overlap(a, add) : for_each_overlap(a, b, tree.nodes[w.b].box, add);
  });
}

void cross_pairs(const Bvh& first, const Bvh& second, Pairs& pairs) {
  pairs.clear();
  PartLists<std::pair<int, int>> parts;
  const BvhTraversal traversal{first, second, false};
  gather(traversal, parts, pairs, [&](NodeWork w, Pairs& found) {
    const Bvh::Leaf &a = traversal.leaf_a(w), &b = traversal.leaf_b(w);
    return for_each_overlap(a, b, second.nodes[w.b].box,
                            [&](int i, int j) { found.emplace_back(a.item[i], b.item[j]); });
  });
}

}  // namespace selvedge
