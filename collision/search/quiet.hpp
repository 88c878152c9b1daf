#pragma once

#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// Parts of a surface that cannot intersect themselves: flat or gently curved ones, in which a search need not look.
//
// Let a part be a disk (connected, one boundary loop, Euler characteristic 1, consistently oriented) and project it to
// a plane. If every triangle keeps its orientation there and the boundary becomes a simple polygon, then the projection
// is one to one, and no two triangles of the part share more than the edge or vertex that they have in common (Volino
// and Magnenat-Thalmann 1994). Proof: round a vertex inside the part the projected triangles fill an angle of 2 pi (1 +
// b) with b >= 0, and at one of the boundary they fill the polygon's angle, on the side of the part, plus 2 pi c with
// c >= 0. By Gauss and Bonnet pi less those boundary angles sum to 2 pi (1 + sum b). For a simple polygon pi less its
// angles sum to 2 pi or, passed the other way, -2 pi: 1 + sum b + sum c is 1 or -1, so that every b and c is zero and
// the projection is one to one near every point. Over a point of the plane there are then as many points of the part as
// the polygon winds round it, none or one; and over a point of the polygon no other than its own, for near that one
// there would be points of the plane with more over them than the polygon winds round them.
struct QuietParts {
  struct Part {
    int node;                // of the tree
    int first_leaf, leaves;  // its triangles
    std::vector<int> loop;   // vertices of its boundary, in order
  };
  std::vector<Part> parts;   // the disks among the nodes that hold enough triangles
  std::vector<int> part_of;  // by node, -1: none
  std::vector<Vec3> normals, node_normals;
  std::vector<char> quiet;  // by node, as of the last mark_quiet
};

// For a tree of the surface's triangles that was built anew. Topology alone.
void find_parts(const Surface&, const Bvh&, QuietParts&);

// Marks the largest parts that are seen to be quiet, one-sidedly: floating-point tests with room for rounding, so that
// what is marked is quiet in exact arithmetic too.
void mark_quiet(const Surface&, const Points& x, const Bvh&, QuietParts&);

// Is the closed polygon simple, with at least `margin` (a length) to spare for its coordinates? False says nothing.
bool surely_simple(const std::vector<Vec2>& polygon, double margin);

}  // namespace selvedge
