#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pipeline/bodies/body.hpp"

// Tools for procedural clips: a figure described by a few numbers, and the pose of SMPL's 24 joints that follows from
// it. The body faces +z, its left is +x, side 0 is left and 1 right. Angles in radians, lengths in metres.
namespace selvedge {

// The measures of a body in the zero pose.
struct Skeleton {
  Points joints;               // 24 x 3
  double floor = 0;            // y of the soles
  double leg = 0, arm = 0;     // hip to ankle and shoulder to wrist, along the bones
  double hip_height = 0;       // of the pelvis above the soles
  double mirror[2] = {1, -1};  // x of a side
};

// joints: 24 x 3, the zero pose; floor: y of the soles; absent: 2 % of a leg below the feet. Throws Error if legs or
// arms have no length, or the joints are not those of an upright body with its left at +x.
Skeleton measured(const Points& joints, std::optional<double> floor);

// All values that are interpolated between keys.
struct Figure {
  static constexpr int size = 28;
  Eigen::Matrix<double, size, 1> values = Eigen::Matrix<double, size, 1>::Zero();

  auto pelvis() { return values.segment<3>(0); }                    // displacement from standing at the origin
  double& yaw() { return values[3]; }                               // to the left
  double& lean() { return values[4]; }                              // forward, from the hips
  double& roll() { return values[5]; }                              // left side up
  auto spine() { return values.segment<3>(6); }                     // total bend forward, to the left, turn to the left
  auto head() { return values.segment<3>(9); }                      // the same of neck and head
  auto arm(int side) { return values.segment<3>(side ? 17 : 12); }  // rotation vector from a mid pose, in chest's axes
  double& elbow(int side) { return values[side ? 20 : 15]; }        // 0: straight
  double& wrist(int side) { return values[side ? 21 : 16]; }        // hand up
  double& knee_out(int side) { return values[22 + side]; }          // the knee to the side, seen from above
  double& heel_up(int side) { return values[24 + side]; }           // on the ball of the foot
  double& shrug(int side) { return values[26 + side]; }             // shoulder up
};

// Stands upright, arms hanging a little away from the body.
Figure standing();

// Sets an arm: from hanging it is turned `out` to the side, then swung `forward`; `in` turns it about its axis so that
// the bent forearm points inward; `elbow` bends it [rad].
void set_arm(Figure&, int side, double out, double forward, double in, double elbow);
void set_arms(Figure&, double out, double forward, double in, double elbow);

// Moves the wrist to a place relative to the middle between the shoulders, in arm's lengths along the chest's axes (x
// to the arm's own side), with the elbow on the side of `pole`. A place out of reach is approached as far as possible.
void reach(Figure&, const Skeleton&, int side, const Vec3& place, const Vec3& pole);
void reach_both(Figure&, const Skeleton&, const Vec3& place, const Vec3& pole);

// The place of a foot (the point on the ground below the ankle when it is flat), and how it rolls.
struct FootPose {
  Vec3 at = Vec3::Zero();  // y: how high the foot is lifted
  double yaw = 0, heel_up = 0, toe_up = 0;
};

// The place of a foot in standing with the pelvis at the origin.
Vec3 stance(const Skeleton&, int side);

// The poses of the figures of all frames. Two-link inverse kinematics puts the feet at their places; the pelvis sinks
// smoothly where legs would not reach.
std::vector<BodyPose> solved(const Skeleton&, std::vector<Figure>, const std::vector<std::array<FootPose, 2>>&);

}  // namespace selvedge
