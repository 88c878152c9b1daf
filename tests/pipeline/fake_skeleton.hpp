#pragma once

#include "pipeline/bodies/body.hpp"
#include "pipeline/bodies/smpl_joints.hpp"

namespace selvedge::fake {

// The 24 joints of an upright body with round sizes and arms out, standing on y = 0 [m]. Arms and legs are not exactly
// straight, as those of real bodies.
inline Points skeleton(double size = 1, double legs = 1) {
  Points x(24, 3);
  const double leg = 0.8 * legs, hip = 0.08 + leg, top = hip + 0.1;
  x.row(0) << 0, top, 0;
  for (int side = 0; side < 2; ++side) {
    const double m = side ? -1 : 1;
    x.row(1 + side) << m * 0.07, hip, -0.005;
    x.row(4 + side) << m * 0.10, hip - 0.48 * leg, 0;
    x.row(7 + side) << m * 0.09, hip - leg, -0.04;
    x.row(10 + side) << m * 0.12, 0.025, 0.08;
    x.row(13 + side) << m * 0.08, top + 0.42, -0.01;
    x.row(16 + side) << m * 0.18, top + 0.45, -0.015;
    x.row(18 + side) << m * 0.44, top + 0.44, -0.04;
    x.row(20 + side) << m * 0.69, top + 0.445, -0.04;
    x.row(22 + side) << m * 0.78, top + 0.44, -0.05;
  }
  x.row(3) << 0, top + 0.11, -0.03;
  x.row(6) << 0, top + 0.24, -0.03;
  x.row(9) << 0, top + 0.3, 0;
  x.row(12) << 0, top + 0.51, -0.04;
  x.row(15) << 0, top + 0.58, 0.01;
  return size * x;
}

// The positions of the joints in a pose.
inline Points posed_joints(const Points& joints, const BodyPose& pose) {
  BodyModel body;
  body.parents = smpl_joint_parents();
  return selvedge::posed_joints(body, joints, pose);
}

}  // namespace selvedge::fake
