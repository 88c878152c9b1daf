#include "pipeline/motions/clip_procedural_figure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/geometry/error.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {
namespace {

constexpr double straightest_leg = 0.985;  // of its length: knees stay bent by 20 degrees and never snap straight

enum Joint { pelvis, hip = 1, spine1 = 3, knee = 4, spine2 = 6, ankle = 7, spine3 = 9, foot = 10, neck = 12 };
enum UpperJoint { collar = 13, head = 15, shoulder = 16, elbow = 18, wrist = 20 };  // plus the side, as for legs

Mat3 about(int axis, double angle) { return rotation_matrix(angle * Vec3::Unit(axis)); }

Vec3 without(const Vec3& v, const Vec3& unit) { return (v - v.dot(unit) * unit).normalized(); }

Vec3 joint(const Skeleton& k, int j) { return row(k.joints, j); }

// Rotation of the upper arm in the chest: its axes are those of the zero pose, the arm along x (-x of the right one).
Mat3 arm_rotation(int side, double out, double forward, double in) {
  const double m = side ? -1 : 1;
  return about(0, -forward) * about(2, m * out) * about(1, -m * in) * about(2, -m * std::numbers::pi / 2);
}

// The middle pose from which rotation vectors of arms are measured: within an arm's reach they stay well below half a
// turn.
Mat3 middle(int side) { return arm_rotation(side, 0.8, 0.8, 0.2); }

Mat3 collar_rotation(int side, const Vec3& upper_arm, double shrug) {
  const double m = side ? -1 : 1;
  return about(2, m * (0.15 * (1 + upper_arm.y()) + shrug)) * about(1, -m * 0.15 * upper_arm.z());
}

double bone(const Skeleton& k, int a, int b) { return (joint(k, b) - joint(k, a)).norm(); }

// Columns: along a bone, the axis about which its joint bends, and their cross product.
Mat3 bone_frame(const Vec3& along, const Vec3& axis) {
  Mat3 frame;
  frame.col(0) = along;
  frame.col(1) = axis;
  frame.col(2) = along.cross(axis);
  return frame;
}

struct Ankle {
  Mat3 rotation;
  Vec3 at;
};

// The foot rolls over the joint at its ball, then over its heel.
Ankle ankle_of(const Skeleton& k, int side, const FootPose& f) {
  const double height = joint(k, ankle + side).y() - k.floor;
  const Vec3 rest(0, height, 0);
  const Vec3 ball = joint(k, foot + side) - joint(k, ankle + side) + rest, heel(0, 0, -0.6 * height);
  const Mat3 up = about(0, f.heel_up), down = about(0, -f.toe_up), turn = about(1, f.yaw);
  const Vec3 rolled = heel + down * (ball + up * (rest - ball) - heel);
  return {turn * down * up, f.at + turn * rolled};
}

struct Leg {
  Mat3 hip, knee;  // in the world
};

Leg solve_leg(const Skeleton& k, int side, const Vec3& hip_at, const Vec3& ankle_at, const Vec3& lateral) {
  const double thigh = bone(k, hip + side, knee + side), shin = bone(k, knee + side, ankle + side);
  const Vec3 line = ankle_at - hip_at;
  const double reach = std::clamp(line.norm(), 1.05 * std::abs(thigh - shin), 0.9999 * (thigh + shin));
  const Vec3 along = line.normalized(), axis = without(lateral, along), front = along.cross(axis);
  const double cosine = (thigh * thigh + reach * reach - shin * shin) / (2 * thigh * reach);
  const Vec3 to_knee = cosine * along + std::sqrt(1 - cosine * cosine) * front;
  const Vec3 to_ankle = (reach * along - thigh * to_knee).normalized();
  const Vec3 rest_thigh = (joint(k, knee + side) - joint(k, hip + side)).normalized();
  const Vec3 rest_shin = (joint(k, ankle + side) - joint(k, knee + side)).normalized();
  const auto turned = [&](const Vec3& to, const Vec3& rest) -> Mat3 {
    return bone_frame(to, axis) * bone_frame(rest, without(Vec3::UnitX(), rest)).transpose();
  };
  return {turned(to_knee, rest_thigh), turned(to_ankle, rest_shin)};
}

Mat3 pelvis_rotation(Figure& f) { return about(1, f.yaw()) * about(0, f.lean()) * about(2, f.roll()); }

Mat3 bent(const Vec3& bend) { return about(1, bend[2]) * about(0, bend[0]) * about(2, -bend[1]); }

Vec3 pelvis_at(const Skeleton& k, Figure& f) { return Vec3(f.pelvis()) + Vec3(0, k.hip_height, 0); }

Vec3 hip_at(const Skeleton& k, Figure& f, int side) {
  return pelvis_at(k, f) + pelvis_rotation(f) * (joint(k, hip + side) - joint(k, pelvis));
}

FootPose raised(FootPose f, double heel_up) {
  f.heel_up += heel_up;
  return f;
}

// How much the pelvis is too high for a leg [m].
double excess(const Skeleton& k, Figure& f, int side, const FootPose& foot_pose) {
  const Vec3 from = hip_at(k, f, side), to = ankle_of(k, side, raised(foot_pose, f.heel_up(side))).at;
  const double reach = straightest_leg * k.leg, flat = (from - to).cwiseProduct(Vec3(1, 0, 1)).norm();
  return std::max(0.0, from.y() - to.y() - std::sqrt(std::max(0.0, reach * reach - flat * flat)));
}

// At least the given values everywhere, and smooth: the largest within three frames, averaged three times.
std::vector<double> smooth_cover(std::vector<double> values) {
  const int n = static_cast<int>(values.size());
  const auto at = [&](const std::vector<double>& v, int i) { return v[std::clamp(i, 0, n - 1)]; };
  std::vector<double> next = values;
  for (int i = 0; i < n; ++i)
    for (int d = -6; d <= 6; ++d) next[i] = std::max(next[i], at(values, i + d));
  for (int round = 0; round < 3; ++round) {
    values = next;
    for (int i = 0; i < n; ++i) {
      double sum = 0;
      for (int d = -2; d <= 2; ++d) sum += at(values, i + d);
      next[i] = sum / 5;
    }
  }
  return next;
}

BodyPose solve(const Skeleton& k, Figure& f, const std::array<FootPose, 2>& feet) {
  std::array<Mat3, 24> local;
  local.fill(Mat3::Identity());
  const Mat3 body = pelvis_rotation(f);
  local[pelvis] = body;
  for (const int j : {spine1, spine2, spine3}) local[j] = bent(Vec3(f.spine()) / 3);
  local[neck] = local[head] = bent(Vec3(f.head()) / 2);
  for (const int side : {0, 1}) {
    const FootPose stand = raised(feet[side], f.heel_up(side));
    const Ankle ankle_pose = ankle_of(k, side, stand);
    const double facing = (f.yaw() + stand.yaw) / 2 + k.mirror[side] * f.knee_out(side);
    // The knee's axis follows the roll of the hips, so that a leg that is raised aside still bends forward.
    const Leg leg = solve_leg(k, side, hip_at(k, f, side), ankle_pose.at, about(1, facing) * Vec3::UnitX());
    local[hip + side] = body.transpose() * leg.hip;
    local[knee + side] = leg.hip.transpose() * leg.knee;
    local[ankle + side] = leg.knee.transpose() * ankle_pose.rotation;
    local[foot + side] = about(0, -stand.heel_up);  // toes stay flat
    const Mat3 arm = middle(side) * rotation_matrix(f.arm(side));
    const Vec3 x = k.mirror[side] * Vec3::UnitX();
    const auto onto_x = [&](int from, int to) { return rotation_between(joint(k, to) - joint(k, from), x); };
    const Mat3 upper = onto_x(shoulder + side, elbow + side), fore = onto_x(elbow + side, wrist + side);
    local[collar + side] = collar_rotation(side, arm * x, f.shrug(side));
    local[shoulder + side] = local[collar + side].transpose() * arm * upper;
    local[elbow + side] = upper.transpose() * about(1, -k.mirror[side] * f.elbow(side)) * fore;
    local[wrist + side] = about(2, k.mirror[side] * f.wrist(side));
  }
  BodyPose pose{Points(24, 3), pelvis_at(k, f) - joint(k, pelvis)};
  for (std::size_t j = 0; j < 24; ++j)
    pose.rotations.row(static_cast<Eigen::Index>(j)) = rotation_vector(local[j]).transpose();
  return pose;
}

}  // namespace

Skeleton measured(const Points& joints, std::optional<double> floor) {
  const auto refuse = [](const std::string& what) {
    throw Error(what, "the joints of a procedural clip",
                "give the 24 joints of SMPL in the zero pose, Y up, left at +x");
  };
  if (joints.rows() != 24) refuse("are " + std::to_string(joints.rows()) + " rows");
  if (!joints.allFinite()) refuse("are not all finite");
  Skeleton k{.joints = joints};
  for (int side = 0; side < 2; ++side) {
    if (k.mirror[side] * (joint(k, shoulder + side) - joint(k, spine3)).x() <= 0) refuse("have the sides exchanged");
    if (joint(k, ankle + side).y() >= joint(k, hip + side).y()) refuse("do not stand upright");
    if (std::min({bone(k, hip + side, knee + side), bone(k, knee + side, ankle + side),
                  bone(k, shoulder + side, elbow + side), bone(k, elbow + side, wrist + side)}) < 1e-3)
      refuse("have limbs without length");
    k.leg += 0.5 * (bone(k, hip + side, knee + side) + bone(k, knee + side, ankle + side));
    k.arm += 0.5 * (bone(k, shoulder + side, elbow + side) + bone(k, elbow + side, wrist + side));
  }
  k.floor = floor ? *floor : std::min(joint(k, foot).y(), joint(k, foot + 1).y()) - 0.02 * k.leg;
  k.hip_height = joint(k, pelvis).y() - k.floor;
  if (std::min(joint(k, ankle).y(), joint(k, ankle + 1).y()) <= k.floor) refuse("have ankles below the floor");
  return k;
}

Figure standing() {
  Figure f;
  set_arms(f, 0.45, 0.05, 0.1, 0.2);
  return f;
}

void set_arm(Figure& f, int side, double out, double forward, double in, double elbow_angle) {
  f.arm(side) = rotation_vector(middle(side).transpose() * arm_rotation(side, out, forward, in));
  f.elbow(side) = elbow_angle;
}

void set_arms(Figure& f, double out, double forward, double in, double elbow_angle) {
  for (const int side : {0, 1}) set_arm(f, side, out, forward, in, elbow_angle);
}

void reach(Figure& f, const Skeleton& k, int side, const Vec3& place, const Vec3& pole) {
  const Vec3 m(k.mirror[side], 1, 1), shoulders = 0.5 * (joint(k, shoulder) + joint(k, shoulder + 1));
  const Vec3 target = shoulders + k.arm * place.cwiseProduct(m), elbow_side = pole.cwiseProduct(m);
  const double upper = bone(k, shoulder + side, elbow + side), fore = bone(k, elbow + side, wrist + side);
  const Vec3 from_collar = joint(k, shoulder + side) - joint(k, collar + side);
  Vec3 u = -Vec3::UnitY();
  Vec3 bend = Vec3::UnitZ();
  double flex = 0;
  for (int round = 0; round < 20; ++round) {  // iterates, since collar and arm depend on each other
    const Vec3 from = joint(k, collar + side) + collar_rotation(side, u, f.shrug(side)) * from_collar;
    const Vec3 along = (target - from).normalized(), off = without(elbow_side, along);
    const double far = std::clamp((target - from).norm(), 1.1 * std::abs(upper - fore), 0.995 * (upper + fore));
    const double cosine = (upper * upper + far * far - fore * fore) / (2 * upper * far);
    u = cosine * along + std::sqrt(1 - cosine * cosine) * off;
    const Vec3 forearm = (far * along - upper * u).normalized();
    bend = without(forearm, u);
    flex = std::acos(std::clamp(u.dot(forearm), -1.0, 1.0));
  }
  Mat3 arm;
  arm.col(0) = k.mirror[side] * u;
  arm.col(1) = bend.cross(k.mirror[side] * u);
  arm.col(2) = bend;
  f.arm(side) = rotation_vector(middle(side).transpose() * arm);
  f.elbow(side) = flex;
}

void reach_both(Figure& f, const Skeleton& k, const Vec3& place, const Vec3& pole) {
  for (const int side : {0, 1}) reach(f, k, side, place, pole);
}

Vec3 stance(const Skeleton& k, int side) {
  return (joint(k, ankle + side) - joint(k, pelvis)).cwiseProduct(Vec3(1, 0, 1));
}

std::vector<BodyPose> solved(const Skeleton& k, std::vector<Figure> figures,
                             const std::vector<std::array<FootPose, 2>>& feet) {
  std::vector<double> sink(figures.size());
  for (std::size_t i = 0; i < figures.size(); ++i)
    for (std::size_t s = 0; s < 2; ++s)
      sink[i] = std::max(sink[i], excess(k, figures[i], static_cast<int>(s), feet[i][s]));
  sink = smooth_cover(std::move(sink));
  std::vector<BodyPose> poses;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    figures[i].pelvis().y() -= sink[i];
    poses.push_back(solve(k, figures[i], feet[i]));
  }
  return poses;
}

}  // namespace selvedge
