#pragma once

#include <string>
#include <vector>

namespace selvedge {

// SMPL's joints by their places in `smpl_joint_names(24)`; of a pair the left one, the right one follows it.
namespace smpl {
enum Joint {
  pelvis = 0,
  hip = 1,
  knee = 4,
  ankle = 7,
  foot = 10,
  shoulder = 16,
  elbow = 18,
  wrist = 20,
  hand = 22,
  joints = 24,
};
}  // namespace smpl

// Parents of SMPL's 24 joints (`smpl_joint_names(24)`), each before its children; -1 for the root.
const std::vector<int>& smpl_joint_parents();

// Where SMPL's 24 joints are among the joints of a body; hands that it lacks are its wrists, -1 for any other.
std::vector<int> smpl_joints_among(const std::vector<std::string>& joints);

}  // namespace selvedge
