#include "pipeline/bodies/body.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "collision/geometry/error.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

constexpr Eigen::Index chunk = 256;  // vertices per task: their blend shapes fit in the L1 cache

// The coefficients of the pose blend shapes: the entries of R(joint) - 1, nine per joint except the root, row by row.
Eigen::VectorXd pose_coefficients(const BodyPose& pose) {
  Eigen::VectorXd coefficients(9 * (pose.rotations.rows() - 1));
  for (int j = 1; j < pose.rotations.rows(); ++j) {
    const Mat3 change = rotation_matrix(row(pose.rotations, j)) - Mat3::Identity();
    for (int k = 0; k < 9; ++k) coefficients[9 * (j - 1) + k] = change(k / 3, k % 3);
  }
  return coefficients;
}

// Adds directions * coefficients to x for the vertices [begin, end). Column by column, so that an element's sum has the
// same order for any chunks; columns with coefficient 0 are not read.
void add_directions(const Eigen::MatrixXd& directions, const Eigen::VectorXd& coefficients, Eigen::Index begin,
                    Eigen::Index end, Points& x) {
  Eigen::Map<Eigen::VectorXd> flat(x.data() + 3 * begin, 3 * (end - begin));
  for (Eigen::Index k = 0; k < coefficients.size(); ++k)
    if (coefficients[k] != 0) flat += coefficients[k] * directions.col(k).segment(3 * begin, flat.size());
}

template <class Body>
void for_chunks(Eigen::Index vertices, const Body& body) {
  const Eigen::Index chunks = (vertices + chunk - 1) / chunk;
#pragma omp parallel for schedule(static) if (chunks > 4)
  for (Eigen::Index c = 0; c < chunks; ++c) body(c * chunk, std::min(vertices, (c + 1) * chunk));
}

void check_shape(const SkinnedSurface& skin, const Eigen::VectorXd& shape) {
  if (shape.size() > skin.shape_directions.cols())
    throw Error(fmt::format("has {} coefficients, the body has {} shape directions", shape.size(),
                            skin.shape_directions.cols()),
                "shape", "give fewer, or read the body with more of its directions");
  if (!shape.allFinite()) throw Error("is not finite", "shape", "give finite coefficients");
}

void check_pose(Eigen::Index joints, const BodyPose& pose) {
  if (pose.rotations.rows() != joints)
    throw Error(fmt::format("has {} joints, the body has {}", pose.rotations.rows(), joints), "pose",
                "match the pose to the body's joints first");
  if (!pose.rotations.allFinite() || !pose.translation.allFinite())
    throw Error("is not finite", "pose", "repair the motion where it was made");
}

// The coefficients of the pose blend shapes; empty if the skin has none.
Eigen::VectorXd checked_correction(const SkinnedSurface& skin, const BodyPose& pose,
                                   const JointTransforms& transforms) {
  const Eigen::Index joints = skin.weights.cols();
  check_pose(joints, pose);
  if (static_cast<Eigen::Index>(transforms.size()) != joints)
    throw Error(fmt::format("has {} transforms, the weights have {} joints", transforms.size(), joints), "pose",
                "take the weights from the same body");
  if (skin.pose_directions.cols() == 0) return {};
  if (skin.pose_directions.cols() != 9 * (joints - 1))
    throw Error(fmt::format("has {} columns for {} joints", skin.pose_directions.cols(), joints), "pose directions",
                fmt::format("give {}", 9 * (joints - 1)));
  return pose_coefficients(pose);
}

Eigen::Matrix<double, 3, 4> blended(const SkinWeights& weights, Eigen::Index vertex,
                                    const JointTransforms& transforms) {
  Eigen::Matrix<double, 3, 4> blend = Eigen::Matrix<double, 3, 4>::Zero();
  for (SkinWeights::InnerIterator entry(weights, vertex); entry; ++entry)
    blend += entry.value() * transforms[entry.col()];
  return blend;
}

}  // namespace

SkinWeights from_entries(Eigen::Index rows, Eigen::Index cols, const std::vector<Eigen::Triplet<double>>& entries) {
  SkinWeights matrix(rows, cols);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Points shaped(const SkinnedSurface& skin, const Eigen::VectorXd& shape) {
  check_shape(skin, shape);
  Points x = skin.rest;
  for_chunks(x.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    add_directions(skin.shape_directions, shape, begin, end, x);
  });
  return x;
}

Points joint_positions(const BodyModel& body, const Eigen::VectorXd& shape) {
  return body.regressor * shaped(body.skin, shape);
}

JointTransforms joint_transforms(const BodyModel& body, const Points& joints, const BodyPose& pose) {
  const std::size_t count = body.parents.size();
  check_pose(static_cast<Eigen::Index>(count), pose);
  if (joints.rows() != static_cast<Eigen::Index>(count))
    throw Error(fmt::format("has {} positions, the body has {} joints", joints.rows(), count), "joints",
                "take them from joint_positions of the same body");
  JointTransforms transforms(count);
  for (std::size_t j = 0; j < count; ++j) {
    // A rotation about the joint's place in the zero pose, then the parent's transform.
    const Vec3 center = row(joints, static_cast<int>(j));
    const Mat3 turn = rotation_matrix(row(pose.rotations, static_cast<int>(j)));
    auto& transform = transforms[j];
    transform << turn, center - turn * center;
    if (body.parents[j] < 0) continue;
    const auto& parent = transforms[body.parents[j]];
    const Mat3 parent_turn = parent.leftCols<3>();
    transform = (parent_turn * transform).eval();
    transform.col(3) += parent.col(3);
  }
  return transforms;
}

Points posed_joints(const BodyModel& body, const Points& joints, const BodyPose& pose) {
  const JointTransforms transforms = joint_transforms(body, joints, pose);
  Points x(joints.rows(), 3);
  for (Eigen::Index j = 0; j < x.rows(); ++j) {
    const Vec3 rest = joints.row(j).transpose();
    x.row(j) = (transforms[j] * rest.homogeneous() + pose.translation).transpose();
  }
  return x;
}

Points posed(const SkinnedSurface& skin, const Eigen::VectorXd& shape, const BodyPose& pose,
             const JointTransforms& transforms) {
  check_shape(skin, shape);
  const Eigen::VectorXd correction = checked_correction(skin, pose, transforms);
  Points x = skin.rest;
  for_chunks(x.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    add_directions(skin.shape_directions, shape, begin, end, x);
    add_directions(skin.pose_directions, correction, begin, end, x);
    for (Eigen::Index v = begin; v < end; ++v) {
      const auto blend = blended(skin.weights, v, transforms);
      const Vec3 before = x.row(v).transpose();
      x.row(v) = (blend.leftCols<3>() * before + blend.col(3) + pose.translation).transpose();
    }
  });
  return x;
}

Points unposed(const SkinnedSurface& skin, const Eigen::VectorXd& shape, const BodyPose& pose,
               const JointTransforms& transforms) {
  constexpr double flat = 1e-3;  // a determinant below this counts as collapsed
  check_shape(skin, shape);
  const Eigen::VectorXd correction = checked_correction(skin, pose, transforms);
  Points x = skin.rest;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const auto blend = blended(skin.weights, v, transforms);
    const Mat3 turn = blend.leftCols<3>();
    if (!(turn.determinant() > flat))
      throw Error(fmt::format("is flattened by the pose at vertex {}", v), "garment",
                  "give the garment in a pose that is nearer to the zero pose");
    x.row(v) = (turn.inverse() * (row(x, static_cast<int>(v)) - pose.translation - blend.col(3))).transpose();
  }
  for_chunks(x.rows(), [&](Eigen::Index begin, Eigen::Index end) {
    add_directions(skin.shape_directions, -shape, begin, end, x);
    add_directions(skin.pose_directions, -correction, begin, end, x);
  });
  return x;
}

Points posed(const BodyModel& body, const Eigen::VectorXd& shape, const BodyPose& pose) {
  return posed(body.skin, shape, pose, joint_transforms(body, joint_positions(body, shape), pose));
}

}  // namespace selvedge
