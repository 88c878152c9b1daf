#pragma once

#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// Parts of a surface that cannot intersect themselves, since they are flat or gently curved. A search skips them.
//
// Let a part be a disk (connected, one boundary loop, Euler characteristic 1, consistently oriented) and project it to
// a plane. If every triangle keeps its orientation there and the boundary becomes a simple polygon, then the projection
// is one to one, and no two triangles of the part share more than the edge or vertex that they have in common (Volino
// and Magnenat-Thalmann 1994). Proof: round a vertex inside the part the projected triangles fill an angle of 2 pi (1 +
// b) with b >= 0, and at one of the boundary they fill the polygon's angle, on the side of the part, plus 2 pi c with
// c >= 0. By Gauss and Bonnet pi less those boundary angles sum to 2 pi (1 + sum b). For a simple polygon pi less its
// angles sum to 2 pi or, passed the other way, -2 pi: 1 + sum b + sum c is 1 or -1, so that every b and c is zero and
// the projection is one to one near every point. Over a point of the plane there are then as many points of the part as
// the polygon winds round it, none or one. Over a point of the polygon there is only its own: near a second one there
// would be points of the plane with more points over them than the polygon's winding number allows.
struct QuietParts {
  struct Part {
    int node;                // its node of the tree
    int first_leaf, leaves;  // its triangles
    std::vector<int> loop;   // vertices of its boundary, in order
  };
  std::vector<Part> parts;   // nodes of the tree that are disks and hold enough triangles
  std::vector<int> part_of;  // by node, -1: none
  std::vector<Vec3> normals, node_normals;
  std::vector<char> quiet;  // by node, as of the last mark_quiet
};

// Finds the parts in a newly built tree of the surface's triangles, from topology alone.
void find_parts(const Surface&, const Bvh&, QuietParts&);

// Marks the largest parts that are proven quiet. The tests are floating-point and conservative: what is marked is quiet
// in exact arithmetic too; what is not marked may be quiet.
void mark_quiet(const Surface&, const Points& x, const Bvh&, QuietParts&);

// True only if the closed polygon stays simple when each coordinate is off by up to `margin` (a length). False says
// nothing.
bool surely_simple(const std::vector<Vec2>& polygon, double margin);

}  // namespace selvedge
