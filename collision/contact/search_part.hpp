#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"
#include "collision/search/end_boxes.hpp"

namespace selvedge {

// Vertices or edges by the leaf of a tree of triangles that owns them, eight together.
struct PrimitiveGroups {
  std::vector<Bvh::Leaf> groups;
  std::vector<int> begin;  // those of leaf l are groups[begin[l] .. begin[l + 1])
  EndLeaves ends;

  // Corner k of triangle t has the primitive primitives(t, k).
  void share_out(const Bvh&, const Triangles& primitives, const std::vector<int>& owner);
};

// A surface that takes part in a search, and the tree of its triangles. What a leaf's triangles own has boxes only once
// something comes near to the leaf: of a body most is away from what it wears.
class SearchPart {
 public:
  SearchPart(const Surface& s, int first) : surface(&s), first_node(first) {}

  // Boxes round the straight motion x0 -> x1 of all nodes, grown by half the radius [m], and with `ends` at both ends
  // of it too. What moves as it did the last time keeps what it has.
  void move(const Points& x0, const Points& x1, double radius, bool ends);
  // Of the leaves that overlap something of the other tree, which is that of another surface, or of all without one.
  void fill(const Bvh* other);
  // By node of the tree: it holds a marked node.
  void mark(const std::vector<char>& nodes);

  const Surface* surface;
  int first_node;
  KeptBvh tree;
  PrimitiveGroups vertices, edges;
  EndLeaves face_ends;
  std::vector<EndBoxes> node_ends;
  std::vector<char> marks;

 private:
  struct Boxes {
    std::vector<Box> vertices, edges, triangles;
  };
  void fill_leaf(int leaf);
  void fill_ends(int leaf);
  void set_edge_boxes(int leaf, Boxes&) const;

  Points from_, to_;  // what the boxes hold
  double radius_ = -1;
  bool ends_ = false;
  Boxes boxes_, start_, end_;
  std::vector<char> filled_;  // by leaf
};

}  // namespace selvedge
