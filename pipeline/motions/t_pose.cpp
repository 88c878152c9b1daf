#include "pipeline/motions/t_pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/bodies/body_smpl.hpp"
#include "pipeline/bodies/mannequin_form.hpp"
#include "pipeline/bodies/smpl_joints.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

constexpr double alike = 20 * std::numbers::pi / 180;

Vec3 mannequin_bone(int joint, int child) {
  static const std::vector<MannequinJoint> joints = mannequin_joints();
  return joints[child].position - joints[joint].position;
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

Points smpl_joints(const BodyModel& body, const Points& joints) {
  const std::vector<int> at = smpl_joints_among(body.joints);
  Points found(smpl::joints, 3);
  for (int j = 0; j < smpl::joints; ++j) {
    const int ours = at[j];
    if (ours < 0)
      throw Error("lacks the joint `" + smpl_joint_names(smpl::joints)[j] + "`", "body " + body.name,
                  "name the body's joints as SMPL does, see docs/mannequin.md");
    found.row(j) = joints.row(ours);
  }
  return found;
}

std::vector<Mat3> turned_limbs(const Points& joints, const Mat3& trunk,
                               const std::function<Vec3(int joint, int child)>& wanted) {
  std::vector<Mat3> turned(smpl::joints, trunk);
  const auto along = [&](int above, int joint, int child) {
    const Mat3& before = turned[above];
    const Vec3 bone = before * (row(joints, child) - row(joints, joint)), to = wanted(joint, child);
    const bool turns = bone.norm() > 0 && to.norm() > 0;
    turned[joint] = turns ? Mat3(rotation_between(bone, to) * before) : before;
  };
  for (const int side : {0, 1}) {
    along(smpl::pelvis, smpl::hip + side, smpl::knee + side);
    along(smpl::hip + side, smpl::knee + side, smpl::ankle + side);
    along(smpl::pelvis, smpl::shoulder + side, smpl::elbow + side);
    along(smpl::shoulder + side, smpl::elbow + side, smpl::wrist + side);
    along(smpl::elbow + side, smpl::wrist + side, smpl::hand + side);
    turned[smpl::hand + side] = turned[smpl::wrist + side];
  }
  return turned;
}

double arms_off_t_pose(const Points& joints) {
  double most = 0;
  for (const auto& [joint, child] : {std::pair{smpl::shoulder, smpl::elbow}, {smpl::elbow, smpl::wrist}})
    for (const int side : {0, 1})
      most = std::max(most, angle_between(row(joints, child + side) - row(joints, joint + side),
                                          mannequin_bone(joint + side, child + side)));
  return most;
}

std::optional<BodyPose> t_pose(const BodyModel& body, const Points& joints) {
  const Points known = smpl_joints(body, joints);
  if (arms_off_t_pose(known) <= alike) return {};
  const std::vector<Mat3> turned = turned_limbs(known, Mat3::Identity(), mannequin_bone);
  const std::vector<int> at = smpl_joints_among(body.joints);
  std::vector<int> smpl_of(body.joints.size(), -1);
  for (int j = smpl::joints - 1; j >= 0; --j) smpl_of[at[j]] = j;

  BodyPose pose{Points(joints.rows(), 3)};
  std::vector<Mat3> world;
  for (std::size_t j = 0; j < body.joints.size(); ++j) {
    const Mat3 above = body.parents[j] < 0 ? Mat3::Identity() : world[body.parents[j]];
    world.push_back(smpl_of[j] < 0 ? above : turned[smpl_of[j]]);
    pose.rotations.row(static_cast<Eigen::Index>(j)) = rotation_vector(above.transpose() * world[j]).transpose();
  }
  return pose;
}

Clip from_own_zero_pose(const Clip& clip, const BodyModel& body, const Points& joints, const BodyPose& t_pose) {
  // A joint turns in the frame of its parent, which differs from the T-pose by the parent's rotation to it.
  const JointTransforms to_t = joint_transforms(body, joints, t_pose);
  Clip result{clip.name, clip.fps, body.joints, {}, clip.shape};
  for (const BodyPose& pose : clip.poses) {
    BodyPose own = matched(pose, clip.joints, body.joints);
    for (std::size_t j = 0; j < to_t.size(); ++j) {
      const Mat3 turn = rotation_matrix(row(own.rotations, static_cast<int>(j))) * to_t[j].leftCols<3>();
      const Mat3 local = body.parents[j] < 0 ? turn : Mat3(to_t[body.parents[j]].leftCols<3>().transpose() * turn);
      own.rotations.row(static_cast<Eigen::Index>(j)) = rotation_vector(local).transpose();
    }
    result.poses.push_back(std::move(own));
  }
  return result;
}

}  // namespace selvedge
