#pragma once

#include <vector>

#include "collision/search/bvh_traversal.hpp"

namespace selvedge {

// Data of the faces in a leaf, in float, which exclude most vertices that project into no face. With d the vector from
// the face's first corner, u . d and w . d are the weights of the second and third corner, and n . d is the height.
struct FrameLeaf {
  Bvh::Lanes origin[3][2], u[3][2], w[3][2], n[3][2];
  Bvh::Lanes slack[2];  // bound of the rounding error of the weights
};

// The projection of a vertex to a face's plane.
struct Foot {
  bool inside = false;
  double height = 0;  // distance along the face's normal [m]
};

// Boxes round all points that project into a face within the radius, one per face. Boxes are empty for faces without
// area and for faces farther than the radius from `around`.
void prism_boxes(const Surface&, const Points& x, double radius, const Box& around, std::vector<Box>& boxes);

// The frames for a tree of those boxes.
void make_frames(const Surface&, const Points& x, const Bvh& tree, std::vector<FrameLeaf>& frames);

// One bit per place. It is false only if the vertex surely does not project into that face within the radius.
unsigned may_project(const FrameLeaf&, const Vec3& p, float radius);

// The vertex projects inside if all weights are in [0, 1], as in Grigorev et al. 2024, algorithm 1. It never does in a
// face without area.
Foot foot_on(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace selvedge
