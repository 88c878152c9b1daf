#pragma once

#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/shapes/sample_times.hpp"

namespace selvedge {

// A motion of a body: poses at a steady rate, its file's own. Joints are matched by name, Y is up, the ground is at y =
// 0 [m].
struct Clip {
  std::string name;
  double fps = 30;
  std::vector<std::string> joints;
  std::vector<BodyPose> poses;
  Eigen::VectorXd shape;  // that the file gives; empty: none
};

double end_of(const Clip&);  // when its last pose is [s]

// The pose at a time [s] from the clip's start: spherical interpolation between poses, the ends are held. Throws Error
// for a clip without poses.
BodyPose pose_at(const Clip&, double time);

// The rotations of a pose in the order of other joints; joints that the clip lacks stay unrotated.
BodyPose matched(const BodyPose&, const std::vector<std::string>& from, const std::vector<std::string>& to);

// The pose that a blend starts from: all rotations zero (arms out), or with the upper arms turned down by 45 degrees.
enum class StartPose { zero, arms_down };

// The clip with that many seconds before it, in which the body goes from the start pose into frame 0, which it passes
// as fast as the clip does; rounded up to whole frames. The start pose has the heading and height of frame 0. Throws
// Error where seconds are negative or the clip has no poses.
Clip blended_in(const Clip&, double seconds, StartPose);
// The same from any rotations of the clip's joints, the root's before the heading.
Clip blended_in(const Clip&, double seconds, const Points& rotations);

}  // namespace selvedge
