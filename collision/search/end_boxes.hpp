#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "collision/search/bvh_traversal.hpp"

namespace selvedge {

// The boxes of leaves, or of groups of items in the form of leaves, at both ends of a motion.
struct EndLeaves {
  std::vector<Bvh::Leaf> start, end;

  void resize(std::size_t leaves);
};

// The boxes of a tree's nodes, from those round its leaves.
void set_end_boxes(const Bvh&, std::span<const EndBoxes> leaves, std::vector<EndBoxes>& nodes);

// Fills in the boxes of one leaf, at index `place` of the EndLeaves, and returns those round all its items.
// start(item) and end(item): the boxes of an item.
template <class StartBox, class EndBox>
EndBoxes set_end_boxes(const Bvh::Leaf& leaf, const StartBox& start, const EndBox& end, int place, EndLeaves& ends) {
  std::ranges::copy(leaf.item, ends.start[place].item);
  std::ranges::copy(leaf.item, ends.end[place].item);
  return {set_leaf_boxes(ends.start[place], start), set_leaf_boxes(ends.end[place], end)};
}

// One bit for each item of the leaf: 1 where it is apart in order (bvh_traversal.hpp) from the boxes `other`.
[[gnu::always_inline]] inline unsigned apart_in_order(const Bvh::Leaf& start, const Bvh::Leaf& end,
                                                      const EndBoxes& other) {
  const auto half = [&](int h) {
    const auto along = [&](int k) {
      return ((start.lo[k][h] > other.start.hi[k]) & (end.lo[k][h] > other.end.hi[k])) |
             ((start.hi[k][h] < other.start.lo[k]) & (end.hi[k][h] < other.end.lo[k]));
    };
    return along(0) | along(1) | along(2);
  };
  return bits_of(half(0), half(1));
}

}  // namespace selvedge
