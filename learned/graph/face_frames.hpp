#pragma once

#include <vector>

#include "collision/search/bvh_traversal.hpp"

namespace selvedge {

// Of the faces in a leaf, in float: what decides for most vertices that they do not project into a face. With d the
// vector from the face's first corner: weights of the second and third corner are u . d and w . d, the height n . d.
struct FrameLeaf {
  Bvh::Lanes origin[3][2], u[3][2], w[3][2], n[3][2];
  Bvh::Lanes slack[2];  // bound of the rounding in the weights
};

// A vertex that projects into a face.
struct Foot {
  bool inside = false;
  double height = 0;  // along the face's normal [m]
};

// Of each face the box round all points that project into it within the radius; empty for a face without area, and for
// one that is farther than the radius from `around`.
void prism_boxes(const Surface&, const Points& x, double radius, const Box& around, std::vector<Box>& boxes);

// For a tree of those boxes.
void make_frames(const Surface&, const Points& x, const Bvh& tree, std::vector<FrameLeaf>& frames);

// One bit a place: false only if the vertex surely does not project into the face there within the radius.
unsigned may_project(const FrameLeaf&, const Vec3& p, float radius);

// Weights in [0, 1], as Grigorev et al. 2024, algorithm 1; never inside a face without area.
Foot foot_on(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace selvedge
