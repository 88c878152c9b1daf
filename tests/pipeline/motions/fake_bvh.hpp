#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "collision/geometry/points.hpp"
#include "pipeline/bodies/smpl_joints.hpp"

namespace selvedge::fake {

// The names of SMPL's joints in a rig; empty: the rig lacks the joint.
using Names = std::vector<std::string>;
inline const Names mixamo = {"Hips",
                             "LeftUpLeg",
                             "RightUpLeg",
                             "Spine",
                             "LeftLeg",
                             "RightLeg",
                             "Spine1",
                             "LeftFoot",
                             "RightFoot",
                             "Spine2",
                             "LeftToeBase",
                             "RightToeBase",
                             "Neck",
                             "LeftShoulder",
                             "RightShoulder",
                             "Head",
                             "LeftArm",
                             "RightArm",
                             "LeftForeArm",
                             "RightForeArm",
                             "LeftHand",
                             "RightHand",
                             "",
                             ""};

// A figure as a separate file: joints at `rest`, in the file's axes and unit, and the rotations of each frame [degrees,
// X Y Z], one row per joint.
struct Rig {
  Names names;
  Points rest;
  std::vector<Points> frames;
};

inline void append(const Rig& rig, std::size_t joint, std::string& text, std::vector<std::size_t>& order) {
  const int parent = smpl_joint_parents()[joint];
  const Vec3 at = row(rig.rest, static_cast<int>(joint)), from = parent < 0 ? Vec3(0, 0, 0) : row(rig.rest, parent);
  order.push_back(joint);
  text += fmt::format("{} {}\n{{\nOFFSET {} {} {}\nCHANNELS {}Xrotation Yrotation Zrotation\n",
                      parent < 0 ? "ROOT" : "JOINT", rig.names[joint], at.x() - from.x(), at.y() - from.y(),
                      at.z() - from.z(), parent < 0 ? "6 Xposition Yposition Zposition " : "3 ");
  bool leaf = true;
  for (std::size_t child = 0; child < 24; ++child)
    if (smpl_joint_parents()[child] == static_cast<int>(joint) && !rig.names[child].empty()) {
      append(rig, child, text, order);
      leaf = false;
    }
  text += leaf ? "End Site\n{\nOFFSET 0 1 0\n}\n}\n" : "}\n";
}

// The figure as a BVH file. `roots` has the position of the root in each frame.
inline std::string text_of(const Rig& rig, const std::vector<Vec3>& roots) {
  std::string text = "HIERARCHY\n";
  std::vector<std::size_t> order;
  append(rig, 0, text, order);
  text += fmt::format("MOTION\nFrames: {}\nFrame Time: 0.0333333\n", rig.frames.size());
  for (std::size_t f = 0; f < rig.frames.size(); ++f) {
    text += fmt::format("{} {} {}", roots[f].x(), roots[f].y(), roots[f].z());
    for (const std::size_t j : order)
      for (int k = 0; k < 3; ++k) text += fmt::format(" {}", rig.frames[f](static_cast<Eigen::Index>(j), k));
    text += '\n';
  }
  return text;
}

}  // namespace selvedge::fake
