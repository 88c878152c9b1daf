#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "collision/geometry/points.hpp"
#include "pipeline/formats/mesh.hpp"

namespace selvedge {

using SkinWeights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

// The matrix of these entries; those at one place are summed.
SkinWeights from_entries(Eigen::Index rows, Eigen::Index cols, const std::vector<Eigen::Triplet<double>>& entries);

// The surface that linear blend skinning deforms: a body, or a garment that follows one.
struct SkinnedSurface {
  Points rest;  // n x 3 in the zero pose and zero shape [m]
  Triangles triangles;
  SkinWeights weights;               // n x joints, rows sum to 1
  Eigen::MatrixXd shape_directions;  // 3n x shapes, row 3 i + k moves coordinate k of vertex i
  Eigen::MatrixXd pose_directions;   // 3n x 9 (joints - 1), or no columns
};

// A body as the SMPL family describes it (Loper et al. 2015, section 3).
struct BodyModel {
  std::string name;
  SkinnedSurface skin;
  std::vector<std::string> joints;  // names, the root first
  std::vector<int> parents;         // of joints, each before its children; -1 for the root
  SkinWeights regressor;            // joints x n: joints from the shaped surface
  NamedVertices meshes = {};        // the named meshes of its file, if any
};

// One pose of a body.
struct BodyPose {
  Points rotations;                 // joints x 3: axis times angle [rad], relative to the parent
  Vec3 translation = Vec3::Zero();  // [m]
};

// The zero pose with the shape's blend shapes added: rest + shape_directions * shape. Missing coefficients are zero.
// Throws Error for more coefficients than the model has.
Points shaped(const SkinnedSurface&, const Eigen::VectorXd& shape);

// Joint positions of the shaped body, joints x 3 [m]. Throws Error as `shaped` does.
Points joint_positions(const BodyModel&, const Eigen::VectorXd& shape);

// Transforms from the zero pose to the pose, one per joint, 3 x 4 each, without the pose's translation.
using JointTransforms = std::vector<Eigen::Matrix<double, 3, 4>>;
JointTransforms joint_transforms(const BodyModel&, const Points& joints, const BodyPose&);

// Joint positions in a pose, with its translation, joints x 3 [m]. Throws Error as joint_transforms does.
Points posed_joints(const BodyModel&, const Points& joints, const BodyPose&);

// The surface in a pose: shape and pose blend shapes, then linear blend skinning, then the translation. In parallel;
// any number of threads gives the same bits. Throws Error for a pose or transforms of another number of joints, and for
// rotations that are not finite. Pose blend shapes: Loper et al. 2015, section 3; one column for each entry of a
// rotation matrix, row by row.
Points posed(const SkinnedSurface&, const Eigen::VectorXd& shape, const BodyPose&, const JointTransforms&);
Points posed(const BodyModel&, const Eigen::VectorXd& shape, const BodyPose&);

// The inverse of `posed`: for a surface whose `rest` is in the pose, its positions in zero pose and shape. Throws Error
// as `posed` does, and for a vertex that its transforms collapse (opposite rotations).
Points unposed(const SkinnedSurface&, const Eigen::VectorXd& shape, const BodyPose&, const JointTransforms&);

// The names of a body's fields in its source, for errors.
struct BodyFields {
  std::string rest = "rest", triangles = "triangles", weights = "weights", shape_directions = "shape_directions",
              pose_directions = "pose_directions", joints = "joints", parents = "parents", regressor = "regressor";
};

// Throws Error, naming `file` and the field, unless sizes match, indices are in range, all numbers are finite, weights
// sum to 1 (within 1e-3), and parents come before children. For readers and generators of bodies.
void check_body(const BodyModel&, const std::string& file, const BodyFields& = {});
void check_skin(const SkinnedSurface&, Eigen::Index joints, const std::string& file, const BodyFields& = {});

}  // namespace selvedge
