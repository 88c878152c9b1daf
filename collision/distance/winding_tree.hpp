#pragma once

#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// For the generalised winding number of a surface that may be open (Jacobson et al. 2013): the solid angle of its
// triangles, seen from a point, over 4 pi. About 1 inside, 0 outside, 1/2 in the middle of a hole.
struct WindingTree {
  struct Node {
    Vec3 centre, area;  // centroid [m]; sum of the triangles' vector areas [m2]
    double radius = 0;  // of a ball round the centre that holds the triangles [m]
  };
  std::vector<Node> nodes;  // parallel to the binary tree's
};

// The nodes for a binary tree that is fitted to x.
WindingTree make_winding_tree(const Bvh&, const Surface&, const Points& x);

// The winding number at p, summed triangle by triangle.
double exact_winding(const Surface&, const Points& x, const Vec3& p);

// Is the winding number over 1/2? Distant nodes count as dipoles (Barill et al. 2018), with an error of about a
// hundredth; where that leaves the answer open, exact_winding decides.
bool winds_round(const WindingTree&, const Bvh&, const Surface&, const Points& x, const Vec3& p);

}  // namespace selvedge
