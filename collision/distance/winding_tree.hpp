#pragma once

#include <vector>

#include "collision/search/bvh.hpp"

namespace selvedge {

// The generalised winding number of a surface that may be open: the solid angle that its triangles fill, seen from a
// point, over 4 pi. About 1 inside, 0 outside, 1/2 in the middle of a hole.
struct WindingTree {
  struct Node {
    Vec3 centre, area;  // weighted by area; sum of the triangles' vector areas [m2]
    double radius = 0;  // of a ball round the centre that holds them [m]
  };
  std::vector<Node> nodes;  // parallel to the binary tree's
};

// For a binary tree that is fitted to x.
WindingTree make_winding_tree(const Bvh&, const Surface&, const Points& x);

// Triangle by triangle: the definition.
double exact_winding(const Surface&, const Points& x, const Vec3& p);

// Is the winding number over 1/2? What is far off counts as a dipole (Barill et al. 2018), with an error of about a
// hundredth; where that leaves the answer open the definition decides.
bool winds_round(const WindingTree&, const Bvh&, const Surface&, const Points& x, const Vec3& p);

}  // namespace selvedge
