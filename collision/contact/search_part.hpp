#pragma once

#include <functional>
#include <vector>

#include "collision/geometry/surface.hpp"
#include "collision/search/end_boxes.hpp"

namespace selvedge {

// The vertices or edges that each leaf of a tree of triangles owns, in groups of eight.
struct PrimitiveGroups {
  std::vector<Bvh::Leaf> groups;
  std::vector<int> begin;  // leaf l has groups[begin[l] .. begin[l + 1])
  EndLeaves ends;

  // primitives(t, k): vertex or edge k of triangle t. owner: of each primitive the triangle that owns it.
  void share_out(const Bvh&, const Triangles& primitives, const std::vector<int>& owner);
};

// A surface that takes part in a search, and the tree of its triangles. Vertices and edges of a leaf get boxes only
// once something comes near the leaf: most of a body is far from its garments.
class SearchPart {
 public:
  SearchPart(const Surface& s, int first) : surface(&s), first_node(first) {}

  // Makes boxes round the straight motion x0 -> x1 of all nodes, grown by half the radius [m]; with `ends` also boxes
  // at both ends of the motion. If the motion is the same as in the last call, boxes are kept.
  void move(const Points& x0, const Points& x1, double radius, bool ends);
  // Fills in boxes of vertices and edges, of the leaves whose nodes are wanted.
  void fill(const std::function<bool(int node)>& wanted);
  // Sets `marks` by node of the tree: 1 if it holds a marked node of the world.
  void mark(const std::vector<char>& nodes);

  const Surface* surface;
  int first_node;
  KeptBvh tree;
  PrimitiveGroups vertices, edges;
  EndLeaves face_ends;
  std::vector<EndBoxes> leaf_ends;  // round all faces of each leaf
  std::vector<EndBoxes> node_ends;
  std::vector<char> marks;

 private:
  void fill_leaf(int leaf);
  void fill_ends(int leaf);

  Points from_, to_;  // the motion of the boxes
  double radius_ = -1;
  bool ends_ = false;
  std::vector<Box> vertex_boxes_, triangle_boxes_;  // round the motion
  std::vector<Box> start_, end_;                    // of the vertices, at its ends
  std::vector<char> filled_;                        // by leaf
};

// Does the box overlap that of any leaf, or with `marked` that of any marked leaf?
bool meets(const SearchPart&, const Box&, bool marked);

}  // namespace selvedge
