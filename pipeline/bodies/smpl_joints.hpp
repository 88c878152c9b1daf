#pragma once

#include <string>
#include <vector>

namespace selvedge {

// Indices of SMPL's joints in `smpl_joint_names(24)`. Of a pair the left one is named; the right one is next.
namespace smpl {
enum Joint {
  pelvis = 0,
  hip = 1,
  knee = 4,
  ankle = 7,
  foot = 10,
  head = 15,
  shoulder = 16,
  elbow = 18,
  wrist = 20,
  hand = 22,
  joints = 24,
};
}  // namespace smpl

// Parents of SMPL's 24 joints (`smpl_joint_names(24)`), each before its children; -1 for the root.
const std::vector<int>& smpl_joint_parents();

// Indices of SMPL's 24 joints among the joints of a body. Missing hands are its wrists; other missing joints are -1.
std::vector<int> smpl_joints_among(const std::vector<std::string>& joints);

}  // namespace selvedge
