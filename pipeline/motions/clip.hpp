#pragma once

#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/shapes/sample_times.hpp"

namespace selvedge {

// A motion of a body: poses at the steady rate of its file. Joints are matched by name, Y is up, the ground is at y = 0
// [m].
struct Clip {
  std::string name;
  double fps = 30;
  std::vector<std::string> joints;
  std::vector<BodyPose> poses;
  Eigen::VectorXd shape;  // of the file; empty: the file has none
};

double end_of(const Clip&);  // time of its last pose [s]

// The pose at a time [s] from the clip's start: spherical interpolation between poses, the ends are held. Throws Error
// for a clip without poses.
BodyPose pose_at(const Clip&, double time);

// The rotations of a pose in the order of other joints; joints that the clip lacks stay unrotated.
BodyPose matched(const BodyPose&, const std::vector<std::string>& from, const std::vector<std::string>& to);

// The pose from which a blend starts: all rotations zero (arms out), or with the upper arms turned down by 45 degrees.
enum class StartPose { zero, arms_down };

// From 0 at s = 0 to 1 at s = 1, where velocity and acceleration are 0; constant beyond.
double ease(double s);

// The clip after a lead-in of that many seconds, rounded up to whole frames, in which the body moves from the start
// pose to frame 0 and reaches it with the clip's velocity. The start pose has the heading and height of frame 0. Throws
// Error if seconds are negative or the clip has no poses.
Clip blended_in(const Clip&, double seconds, StartPose);
// The same from any rotations of the clip's joints; the heading of frame 0 is added to the root's.
Clip blended_in(const Clip&, double seconds, const Points& rotations);

}  // namespace selvedge
