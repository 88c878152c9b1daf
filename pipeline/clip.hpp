#pragma once

#include <string>
#include <vector>

#include "pipeline/body.hpp"

namespace selvedge {

// A motion of a body: poses at a steady rate. Joints are matched by name, Y is up, the ground is at y = 0 [m].
struct Clip {
  std::string name;
  double fps = 30;
  std::vector<std::string> joints;
  std::vector<BodyPose> poses;
  Eigen::VectorXd shape;  // that the file gives; empty: none
};

// The pose at a time [s] from the clip's start: spherical interpolation between poses, the ends are held.
BodyPose pose_at(const Clip&, double time);

// The same motion at another rate.
Clip resampled(const Clip&, double fps);

// The rotations of a pose in the order of other joints; joints that the clip lacks stay unrotated.
BodyPose matched(const BodyPose&, const std::vector<std::string>& from, const std::vector<std::string>& to);

}  // namespace selvedge
