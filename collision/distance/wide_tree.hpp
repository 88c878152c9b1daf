#pragma once

#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// The tree of a surface's triangles (bvh.hpp) with eight children per node, for searches that compare one point with
// all eight at once. Floats, relative to `origin`. Leaf i is leaf i of the binary tree.
struct WideTree {
  static constexpr int width = 8;
  struct Node {
    float lo[3][width], hi[3][width];  // boxes of the children, rounded outward; infinite where there is none
    int child[width];                  // a node; below 0: the leaf ~child
    int source[width];                 // nodes of the binary tree; -1: none
  };
  struct Leaf {
    float corner[3][3][width];  // [corner of the triangle][coordinate][index in the leaf]
    int triangle[width];        // -1: none
  };
  Vec3 origin = Vec3::Zero();
  double extent = 0;        // largest distance of a corner from the origin [m]
  std::vector<Node> nodes;  // root first
  std::vector<Leaf> leaves;
};

// Topology alone; `refit` fills in the boxes and corners.
WideTree widen(const Bvh&);
// Fills in boxes and corners from a binary tree that is fitted to x. Triangles marked in `left_out`, which may be
// empty, are skipped.
void refit(WideTree&, const Bvh&, const Surface&, const Points& x, std::span<const char> left_out);

}  // namespace selvedge
