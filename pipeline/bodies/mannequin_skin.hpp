#pragma once

#include <algorithm>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// The mannequin above the floor (mannequin_form.hpp): the half at x >= 0 first, then the mirror images of vertices not
// at x = 0.
struct MannequinMesh {
  Points x;
  Triangles triangles;
  int half = 0;           // vertices at x >= 0
  std::vector<int> twin;  // of each vertex: its mirror image, itself at x = 0
};
MannequinMesh mannequin_mesh();

// Weights of all joints, n x 24, rows sum to 1, at most six a vertex. Each joint takes a share of its parent's weight
// that rises smoothly from 0 to 1 across the joint; then neighbours are averaged a few times.
Eigen::MatrixXd mannequin_weights(const MannequinMesh&);

// The joint regressor, 24 x n; rows sum to 1, no weight is below zero: a band of vertices round each joint, weighted so
// that joints follow any affine map of the body.
SkinWeights mannequin_regressor(const MannequinMesh&);

// Displacements for one unit of each shape coefficient, 3n x 10 [m].
Eigen::MatrixXd mannequin_directions(const MannequinMesh&, const Eigen::MatrixXd& weights);

// Rises from 0 at `from` to 1 at `to`, with slope 0 at both (Hermite).
inline double smooth_step(double value, double from, double to) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace selvedge
