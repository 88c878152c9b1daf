#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/motions/clip_bvh.hpp"
#include "pipeline/motions/clip_procedural_figure.hpp"
#include "pipeline/motions/t_pose.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

struct Source {
  std::vector<int> joint;  // of the file, for each of SMPL's
  Mat3 upright;            // file's axes to Y up
  BvhPose rest;

  Vec3 at(const BvhPose& pose, int smpl) const { return upright * row(pose.positions, joint[smpl]); }
  Vec3 hips(const BvhPose& pose) const { return 0.5 * (at(pose, smpl::hip) + at(pose, smpl::hip + 1)); }
  // The rotation of a joint from rest, with Y up.
  Mat3 turned(const BvhPose& pose, int smpl) const {
    const auto j = static_cast<std::size_t>(joint[smpl]);
    return upright * pose.rotations[j] * rest.rotations[j].transpose() * upright.transpose();
  }
};

// The rotation, in quarter turns, that takes the axis along which the file's figure stands at rest to Y; nothing if it
// does not stand upright.
std::optional<Mat3> upright_axes(const Source& s) {
  const auto middle = [&](int left) -> Vec3 {
    return 0.5 * (row(s.rest.positions, s.joint[left]) + row(s.rest.positions, s.joint[left + 1]));
  };
  const Vec3 legs = middle(smpl::hip) - middle(smpl::ankle), trunk = middle(smpl::shoulder) - middle(smpl::hip);
  int axis = 0;
  (legs + trunk).cwiseAbs().maxCoeff(&axis);
  const Vec3 up = std::copysign(1, (legs + trunk)[axis]) * Vec3::Unit(axis);
  if (!(legs.dot(up) >= 0.7 * legs.norm() && trunk.dot(up) >= 0.7 * trunk.norm())) return {};
  return rotation_between(up, Vec3::UnitY());
}

// If the zero pose should be the rest pose but does not stand upright, as in much motion capture, the first frame is
// used: recordings mostly begin in a T-pose or an A-pose.
Source upright_source(const BvhFile& bvh, const BvhOptions& options) {
  Source s{matched_joints(bvh, options.joints), Mat3::Identity(), bvh_pose(bvh, options.rest_frame)};
  std::optional<Mat3> upright = upright_axes(s);
  if (!upright && options.rest_frame < 0) {
    s.rest = bvh_pose(bvh, 0, s.joint[smpl::pelvis]);
    upright = upright_axes(s);
  }
  if (!upright)
    throw Error(options.rest_frame < 0 ? std::string("stands upright neither in its zero pose nor in its first frame")
                                       : fmt::format("does not stand upright in frame {}", options.rest_frame),
                bvh.file,
                "give the number of a frame in which it does beside the clip in the scene, rest_frame: NUMBER");
  s.upright = *upright;
  return s;
}

double limb(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).norm() + (c - b).norm(); }

double leg_ratio(const BvhFile& bvh, const Source& s, const Skeleton& k) {
  double leg = 0;
  for (const int side : {0, 1})
    leg +=
        0.5 * limb(s.at(s.rest, smpl::hip + side), s.at(s.rest, smpl::knee + side), s.at(s.rest, smpl::ankle + side));
  if (!(leg > 0)) throw Error("has legs without length", bvh.file, "give joints that lie apart");
  return k.leg / leg;
}

// For each joint of the body the rotation that takes its zero pose to the file's rest pose.
std::vector<Mat3> alignment(const Source& s, const Skeleton& k) {
  const auto angle = [](const Vec3& left, const Vec3& right) {
    return std::atan2(right.z() - left.z(), left.x() - right.x());
  };
  const double turn = angle(s.at(s.rest, smpl::hip), s.at(s.rest, smpl::hip + 1)) -
                      angle(row(k.joints, smpl::hip), row(k.joints, smpl::hip + 1));
  const Mat3 heading = rotation_matrix(Vec3(0, turn, 0));  // from hip to hip, seen from above
  return turned_limbs(k.joints, heading, [&](int joint, int child) -> Vec3 {
    const bool known = child < smpl::hand && s.joint[child] >= 0;
    return known ? Vec3(s.at(s.rest, child) - s.at(s.rest, joint)) : Vec3::Zero();
  });
}

// A joint that the file lacks follows its parent.
BodyPose pose_of(const Source& s, const BvhPose& pose, const std::vector<Mat3>& align) {
  BodyPose result{Points(24, 3)};
  std::vector<Mat3> world(24);
  for (std::size_t j = 0; j < 24; ++j) {
    const int parent = smpl_joint_parents()[j];
    const Mat3 above = parent < 0 ? Mat3::Identity() : world[parent];
    world[j] = s.joint[j] < 0 ? above : Mat3(s.turned(pose, static_cast<int>(j)) * align[j]);
    result.rotations.row(static_cast<Eigen::Index>(j)) = rotation_vector(above.transpose() * world[j]).transpose();
  }
  return result;
}

}  // namespace

Clip retargeted(const BvhFile& bvh, const Points& joints, const BvhOptions& options) {
  if (options.rest_frame < -1 || options.rest_frame >= bvh.motion.rows())
    throw Error(fmt::format("has no frame {} to rest in, it has {}", options.rest_frame, bvh.motion.rows()), bvh.file,
                "frames count from 0; -1 is the zero pose");
  if (options.scale < 0) throw Error(fmt::format("has scale {}", options.scale), bvh.file, "metres a unit, above 0");
  const Skeleton k = measured(joints, options.floor);
  const Source s = upright_source(bvh, options);
  const double scale = options.scale > 0 ? options.scale : leg_ratio(bvh, s, k);
  const std::vector<Mat3> align = alignment(s, k);
  BodyModel body;
  body.parents = smpl_joint_parents();

  Clip clip{std::filesystem::path(bvh.file).stem().string(), bvh.fps, smpl_joint_names(24), {}, {}};
  const Vec3 root = row(k.joints, smpl::pelvis),
             hips = 0.5 * (row(k.joints, smpl::hip) + row(k.joints, smpl::hip + 1)) - root;
  Vec3 origin = Vec3::Zero();
  double lowest = std::numeric_limits<double>::infinity();  // of the feet, compared to standing
  for (int f = 0; f < bvh.motion.rows(); ++f) {
    const BvhPose theirs = bvh_pose(bvh, f, s.joint[smpl::pelvis]);
    BodyPose pose = pose_of(s, theirs, align);
    const Mat3 turn = rotation_matrix(row(pose.rotations, smpl::pelvis));
    pose.translation = scale * s.hips(theirs) - turn * hips - root;
    if (f == 0) origin = (pose.translation + root).cwiseProduct(Vec3(1, 0, 1));
    const Points posed = posed_joints(body, k.joints, pose);
    for (const int foot : {+smpl::ankle, smpl::ankle + 1, +smpl::foot, smpl::foot + 1})
      lowest = std::min(lowest, posed(foot, 1) - (k.joints(foot, 1) - k.floor));
    clip.poses.push_back(std::move(pose));
  }
  for (BodyPose& pose : clip.poses) pose.translation -= origin + Vec3(0, lowest, 0);
  return clip;
}

}  // namespace selvedge
