#pragma once

#include <span>
#include <vector>

#include "collision/bvh_traversal.hpp"

namespace selvedge {

// The boxes of leaves, or of groups like them, at both ends of a motion.
struct EndLeaves {
  std::vector<Bvh::Leaf> start, end;
  std::vector<EndBoxes> bounds;  // of each leaf
};

// Of the leaves' items, whose boxes at both ends are given.
void set_end_boxes(std::span<const Bvh::Leaf> leaves, std::span<const Box> start, std::span<const Box> end, EndLeaves&);

// Of a tree's nodes, from those of its leaves.
void set_end_boxes(const Bvh&, const EndLeaves&, std::vector<EndBoxes>& nodes);

// One bit an item of the leaf: it is apart in order from what has the boxes `other`.
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
