#pragma once

#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "collision/geometry/box.hpp"
#include "collision/geometry/surface.hpp"

namespace selvedge {

// Boxes of the vertices over the straight motion x0 -> x1, grown by `radius` [m] on every side. x1 may be x0. A vertex
// with an undefined coordinate has an empty box, and so have its triangles.
void vertex_boxes(const Points& x0, const Points& x1, double radius, std::vector<Box>& boxes);
void triangle_boxes(const Surface&, std::span<const Box> vertices, std::vector<Box>& boxes);
// Both steps at once.
void triangle_boxes(const Surface&, const Points& x0, const Points& x1, double radius, std::vector<Box>& boxes);

// Binary AABB tree with wide leaves. Leaves are stored in order, so that a node's leaves are contiguous. The two
// children of a node are next to each other and come after it. The nodes below a block's root are contiguous.
struct Bvh {
  static constexpr int leaf_size = 8;
  struct Node {
    Box box;
    int child = 0;  // children child and child + 1; below 0: the leaf ~child
    int first = 0;  // the first of its leaves
  };
  // Four floats at once: a vector extension of gcc and clang, one register on every x86-64.
  using Lanes [[gnu::vector_size(16)]] = float;
  struct Leaf {
    Lanes lo[3][2], hi[3][2];  // boxes by coordinate, place i in lane i % 4 of half i / 4
    int item[leaf_size];       // -1: a place that is left over, where lo and hi are NaN
  };
  struct Block {  // refitted by one thread: nodes below `root` are [begin, end)
    int root, begin, end;
  };
  std::vector<Node> nodes;  // root first
  std::vector<Leaf> leaves;
  std::vector<Block> blocks;
  std::vector<int> top;  // nodes above the blocks, parents first
  int item_count = 0;
};

Bvh build_bvh(std::span<const Box> items);     // items may be empty
void refit(Bvh&, std::span<const Box> items);  // same items, moved
// Writes the boxes of a leaf's items into it and returns their common box. item_box(i): the box of item i.
template <class ItemBox>
Box set_leaf_boxes(Bvh::Leaf&, const ItemBox& item_box);
// Total surface area of the boxes over that of the root: rises as a refitted tree degrades.
double bvh_cost(const Bvh&);

// A tree that is refitted until its cost has grown by a quarter, and then built anew. This affects only the time taken
// and the order of pairs.
struct KeptBvh {
  Bvh bvh;
  double built_cost = 0;
  bool built = false;
};
// Fits the tree to the boxes. True if it was built anew.
bool update(KeptBvh&, std::span<const Box> items);

// Pairs (i, j) whose boxes overlap, in an order that depends on the tree alone and not on the thread count. self_pairs
// lists each unordered pair once, i < j. `pairs` is overwritten.
void self_pairs(const Bvh&, std::vector<std::pair<int, int>>& pairs);
void cross_pairs(const Bvh& a, const Bvh& b, std::vector<std::pair<int, int>>& pairs);

template <class ItemBox>
Box set_leaf_boxes(Bvh::Leaf& leaf, const ItemBox& item_box) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  Box bounds = empty_box;
  for (int i = 0; i < Bvh::leaf_size; ++i) {
    const bool used = leaf.item[i] >= 0;
    const Box box = used ? item_box(leaf.item[i]) : empty_box;
    for (int k = 0; k < 3; ++k) {
      leaf.lo[k][i / 4][i % 4] = used ? box.lo[k] : none;
      leaf.hi[k][i / 4][i % 4] = used ? box.hi[k] : none;
    }
    bounds = join(bounds, box);
  }
  return bounds;
}

}  // namespace selvedge
