#include "pipeline/drapes/drape_draws.hpp"

#include <algorithm>
#include <numbers>

#include "pipeline/bodies/smpl_joints.hpp"

namespace selvedge {
namespace {

// Ranges of axis times angle per coordinate [deg]. A pair has the range of the left joint; the right one is mirrored.
struct JointRange {
  int joint;
  bool paired;
  std::array<double, 3> low, high;
};
constexpr std::array joint_ranges{
    JointRange{3, false, {-8, -10, -7}, {14, 10, 7}},                 // spine, three joints
    JointRange{6, false, {-8, -10, -7}, {14, 10, 7}},                 //
    JointRange{9, false, {-6, -8, -6}, {10, 8, 6}},                   //
    JointRange{12, false, {-15, -30, -10}, {20, 30, 10}},             // neck
    JointRange{13, true, {-4, -8, -8}, {4, 8, 8}},                    // collar
    JointRange{smpl::shoulder, true, {-25, -50, -68}, {25, 20, 35}},  //
    JointRange{smpl::elbow, true, {-15, -80, -10}, {15, 0, 10}},      //
    JointRange{smpl::wrist, true, {-20, -20, -20}, {20, 20, 20}},     //
    JointRange{smpl::hip, true, {-35, -10, 0}, {15, 10, 12}},         //
    JointRange{smpl::knee, true, {0, 0, 0}, {45, 0, 0}},              //
};

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

BodyPose draw_pose(RandomStream& random, const std::vector<std::string>& joints, double range) {
  constexpr double degree = std::numbers::pi / 180;
  const std::vector<int> places = smpl_joints_among(joints);
  BodyPose pose{Points::Zero(static_cast<Eigen::Index>(joints.size()), 3)};
  for (const JointRange& one : joint_ranges)
    for (int side = 0; side <= (one.paired ? 1 : 0); ++side) {
      Vec3 angles;
      for (std::size_t k = 0; k < 3; ++k)
        angles[static_cast<int>(k)] = range * degree * random.between(one.low[k], one.high[k]);
      if (side == 1) angles = Vec3(angles[0], -angles[1], -angles[2]);
      const int place = places[static_cast<std::size_t>(one.joint + side)];
      if (place >= 0) pose.rotations.row(place) = angles.transpose();
    }
  return pose;
}

Eigen::VectorXd draw_body_shape(RandomStream& random, Eigen::Index coefficients, double spread) {
  Eigen::VectorXd shape(coefficients);
  for (double& value : shape) value = std::clamp(spread * random.normal(), -2.0, 2.0);
  return shape;
}

Style draw_style(RandomStream& random, double spread) {
  Style style;
  for (double& value : style) value = spread * random.uniform();
  return style;
}

Points styled(const Points& rest, const Points& joints, const Style& style) {
  const double shoulder = 0.5 * (joints(smpl::shoulder, 0) - joints(smpl::shoulder + 1, 0));
  const double armpit = 0.5 * (joints(smpl::shoulder, 1) + joints(smpl::shoulder + 1, 1)) - 0.12;
  const Vec3 neck = row(joints, 12), trunk = row(joints, 9);
  Points x = rest;
  for (int v = 0; v < x.rows(); ++v) {
    Vec3 p = row(rest, v);
    const double out = std::abs(p.x()) - shoulder;
    const double on_trunk = 1 - smooth_step((out + 0.02) / 0.06);
    p.x() += 0.08 * style[0] * on_trunk * p.x();
    p.z() += 0.08 * style[0] * on_trunk * (p.z() - trunk.z());
    if (p.y() < armpit) p.y() += 0.12 * style[1] * on_trunk * (p.y() - armpit);
    if (out > 0) p.x() += (p.x() > 0 ? 1 : -1) * 0.2 * style[2] * out * smooth_step(out / 0.05);
    const double from_neck = std::hypot(p.x() - neck.x(), p.z() - neck.z());
    const double at_neck = (1 - smooth_step((from_neck - 0.05) / 0.1)) * smooth_step((p.y() - armpit) / 0.1);
    p.x() += 0.25 * style[3] * at_neck * (p.x() - neck.x());
    p.z() += 0.25 * style[3] * at_neck * (p.z() - neck.z());
    x.row(v) = p.transpose();
  }
  return x;
}

}  // namespace selvedge
