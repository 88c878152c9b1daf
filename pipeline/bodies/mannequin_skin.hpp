#pragma once

#include <algorithm>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// The mannequin above the floor (mannequin_form.hpp): the half at x >= 0 first, then the mirror images of what is not
// at x = 0.
struct MannequinMesh {
  Points x;
  Triangles triangles;
  int half = 0;           // vertices at x >= 0
  std::vector<int> twin;  // of each vertex: its mirror image, itself at x = 0
};
MannequinMesh mannequin_mesh();

// Weights of all joints, n x 24, rows sum to 1, at most six a vertex. Each joint takes a share of what its parent has,
// which rises smoothly from nothing to all across the joint; then neighbours are averaged a few times.
Eigen::MatrixXd mannequin_weights(const MannequinMesh&);

// 24 x n, rows sum to 1, no weight below zero: a band of vertices round each joint, weighted so that any affine map of
// the body takes the joints along.
SkinWeights mannequin_regressor(const MannequinMesh&);

// Displacements for one unit of each shape, 3n x 10.
Eigen::MatrixXd mannequin_directions(const MannequinMesh&, const Eigen::MatrixXd& weights);

// From 0 at `from` to 1 at `to`, at rest at both (Hermite).
inline double smooth_step(double value, double from, double to) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace selvedge
