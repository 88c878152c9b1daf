#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "collision/surface.hpp"

namespace selvedge {

// Axis-aligned box in float, always rounded outward: it never loses a point that it was made from.
struct Box {
  std::array<float, 3> lo, hi;
};

inline bool overlap(const Box& a, const Box& b) {
  return a.lo[0] <= b.hi[0] && b.lo[0] <= a.hi[0] && a.lo[1] <= b.hi[1] && b.lo[1] <= a.hi[1] && a.lo[2] <= b.hi[2] &&
         b.lo[2] <= a.hi[2];
}

// Boxes of the triangles over the straight motion x0 -> x1, inflated by `radius` [m] on every side. x1 may be x0.
void triangle_boxes(const Surface&, const Points& x0, const Points& x1, double radius, std::vector<Box>& boxes);

// Binary AABB tree. Leaves hold one item each; internal node k has children left[k] and right[k].
struct Bvh {
  struct Node {
    Box box;
    int left = -1, right = -1;  // children; left < 0: a leaf that holds item ~left
  };
  std::vector<Node> nodes;  // root first, parents before children
  int item_count = 0;
};

Bvh build_bvh(std::span<const Box> items);     // items may be empty
void refit(Bvh&, std::span<const Box> items);  // same items, moved
// Total surface area of the internal boxes over that of the root: rises as a refitted tree degrades.
double bvh_cost(const Bvh&);

// Pairs (i, j) whose boxes overlap, in an order that depends on the tree alone and not on the thread count.
// self_pairs: i != j, each unordered pair once. `pairs` is overwritten.
void self_pairs(const Bvh&, std::vector<std::pair<int, int>>& pairs);
void cross_pairs(const Bvh& a, const Bvh& b, std::vector<std::pair<int, int>>& pairs);

}  // namespace selvedge
