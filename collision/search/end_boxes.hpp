#pragma once

#include <span>
#include <vector>

#include "collision/search/bvh_traversal.hpp"

namespace selvedge {

// The boxes of leaves, or of groups like them, at both ends of a motion.
struct EndLeaves {
  std::vector<Bvh::Leaf> start, end;
  std::vector<EndBoxes> bounds;  // of each leaf

  void resize(std::size_t leaves);
};

// Of a leaf's items, whose boxes at both ends are given; it is the one at that place of the EndLeaves.
void set_end_boxes(const Bvh::Leaf&, std::span<const Box> start, std::span<const Box> end, int place, EndLeaves&);

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
