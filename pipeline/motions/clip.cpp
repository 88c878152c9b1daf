#include "pipeline/motions/clip.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

using Quaternion = Eigen::Quaterniond;

Quaternion quaternion(const Points& rotations, Eigen::Index joint) {
  const Vec3 vector = rotations.row(joint).transpose();
  const double angle = vector.norm();
  if (angle == 0) return Quaternion::Identity();
  return Quaternion(Eigen::AngleAxisd(angle, vector / angle));
}

Vec3 vector_of(const Quaternion& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

// Interpolates from a to b, each joint by the shorter rotation.
BodyPose between(const BodyPose& a, const BodyPose& b, double s) {
  BodyPose pose{Points(a.rotations.rows(), 3), (1 - s) * a.translation + s * b.translation};
  for (Eigen::Index j = 0; j < a.rotations.rows(); ++j)
    pose.rotations.row(j) = vector_of(quaternion(a.rotations, j).slerp(s, quaternion(b.rotations, j))).transpose();
  return pose;
}

void check_has_poses(const Clip& clip) {
  if (clip.poses.empty()) throw Error("has no poses", "clip " + clip.name, "");
  if (!(clip.fps > 0)) throw Error("has no frame rate", "clip " + clip.name, "");
}

double ease_integral_to_end(double s) { return 0.5 - s * s * s * s * (2.5 + s * (s - 3)); }

// The rotation about the vertical in a rotation (swing and twist).
Quaternion heading(const Quaternion& rotation) {
  const Quaternion twist(rotation.w(), 0, rotation.y(), 0);
  return twist.norm() < 1e-9 ? Quaternion::Identity() : twist.normalized();
}

Points start_rotations(const Clip& clip, StartPose start) {
  Points rotations = Points::Zero(clip.poses.front().rotations.rows(), 3);
  const double down = start == StartPose::arms_down ? std::numbers::pi / 4 : 0;
  for (Eigen::Index j = 0; j < rotations.rows(); ++j) {
    const std::string& name = clip.joints[j];
    if (name == "left_shoulder") rotations(j, 2) = -down;
    if (name == "right_shoulder") rotations(j, 2) = down;
  }
  return rotations;
}

// The start pose with the heading and place of frame 0.
BodyPose start_pose(const Clip& clip, const Points& rotations) {
  const BodyPose& first = clip.poses.front();
  BodyPose pose{rotations, first.translation};
  if (pose.rotations.rows() > 0)
    pose.rotations.row(0) = vector_of(heading(quaternion(first.rotations, 0)) * quaternion(rotations, 0)).transpose();
  return pose;
}

// The clip before its start, mirrored in frame 0: the velocity there is that of the clip.
BodyPose mirrored(const Clip& clip, double time) {
  const BodyPose& first = clip.poses.front();
  const BodyPose later = pose_at(clip, time);
  BodyPose pose{Points(first.rotations.rows(), 3), 2 * first.translation - later.translation};
  for (Eigen::Index j = 0; j < first.rotations.rows(); ++j) {
    const Quaternion at = quaternion(first.rotations, j);
    pose.rotations.row(j) = vector_of(at * quaternion(later.rotations, j).conjugate() * at).transpose();
  }
  return pose;
}

}  // namespace

double end_of(const Clip& clip) {
  check_has_poses(clip);
  return static_cast<double>(clip.poses.size() - 1) / clip.fps;
}

BodyPose pose_at(const Clip& clip, double time) {
  check_has_poses(clip);
  constexpr double rounding = 1e-9;  // times of another rate this near to a frame count as at it
  const auto [k, share] = steady_place(clip.poses.size(), clip.fps, time);
  if (share < rounding) return clip.poses[k];
  return 1 - share < rounding ? clip.poses[k + 1] : between(clip.poses[k], clip.poses[k + 1], share);
}

BodyPose matched(const BodyPose& pose, const std::vector<std::string>& from, const std::vector<std::string>& to) {
  BodyPose result{Points::Zero(static_cast<Eigen::Index>(to.size()), 3), pose.translation};
  for (std::size_t j = 0; j < to.size(); ++j) {
    const auto found = std::find(from.begin(), from.end(), to[j]);
    if (found != from.end())
      result.rotations.row(static_cast<Eigen::Index>(j)) = pose.rotations.row(found - from.begin());
  }
  return result;
}

double ease(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 + s * (6 * s - 15));
}

Clip blended_in(const Clip& clip, double seconds, StartPose start) {
  check_has_poses(clip);
  return blended_in(clip, seconds, start_rotations(clip, start));
}

Clip blended_in(const Clip& clip, double seconds, const Points& rotations) {
  check_has_poses(clip);
  if (!(seconds >= 0)) throw Error(fmt::format("blends in over {} s", seconds), "clip " + clip.name, "0 or more");
  const int frames = static_cast<int>(std::ceil(seconds * clip.fps - 1e-9));
  Clip result = clip;
  result.poses.clear();
  const BodyPose rest = start_pose(clip, rotations);
  const Vec3 first = clip.poses.front().translation;
  const Vec3 velocity = clip.fps * (pose_at(clip, 1 / clip.fps).translation - first);
  for (int f = 0; f < frames; ++f) {
    const double s = static_cast<double>(f) / frames, before = (frames - f) / clip.fps;
    BodyPose pose = between(rest, mirrored(clip, before), ease(s));
    // Mirrored walking would come from behind and go back first; along the ground the velocity eases in instead.
    const double way = frames / clip.fps * ease_integral_to_end(s);
    for (const int axis : {0, 2}) pose.translation[axis] = first[axis] - way * velocity[axis];
    result.poses.push_back(std::move(pose));
  }
  result.poses.insert(result.poses.end(), clip.poses.begin(), clip.poses.end());
  return result;
}

}  // namespace selvedge
