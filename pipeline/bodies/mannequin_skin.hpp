#pragma once

#include <algorithm>

#include "pipeline/bodies/body.hpp"
#include "pipeline/shapes/mirrored_mesh.hpp"

namespace selvedge {

// The mannequin above the floor (mannequin_form.hpp).
MirroredMesh mannequin_mesh();

// Weights of all joints, n x 24, rows sum to 1, at most six a vertex. Each joint takes a share of its parent's weight
// that rises smoothly from 0 to 1 across the joint; then neighbours are averaged a few times.
Eigen::MatrixXd mannequin_weights(const MirroredMesh&);

// The joint regressor, 24 x n; rows sum to 1, no weight is below zero: a band of vertices round each joint, weighted so
// that joints follow any affine map of the body.
SkinWeights mannequin_regressor(const Points& x);

// Displacements for one unit of each shape coefficient, 3n x 10 [m].
Eigen::MatrixXd mannequin_directions(const MirroredMesh&, const Eigen::MatrixXd& weights);

// Rises from 0 at `from` to 1 at `to`, with slope 0 at both (Hermite).
inline double smooth_step(double value, double from, double to) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace selvedge
