#pragma once

#include <vector>

#include "pipeline/shapes/implicit_form.hpp"

namespace selvedge {

// Tables of the mannequin, all above the floor y = 0, facing +Z, left is +X [m]; make_mannequin moves the pelvis to the
// origin.

struct MannequinJoint {
  const char* name;
  int parent;
  Vec3 position;
};

// SMPL's 24 joints (Loper et al. 2015) in its order.
std::vector<MannequinJoint> mannequin_joints();

// The body's surface, or that of some of its limbs merged with other solids. Valid for x >= 0.
enum class MannequinLimb { torso, head, arm, leg };
Form mannequin_form(const std::vector<MannequinLimb>& = {MannequinLimb::torso, MannequinLimb::head, MannequinLimb::arm,
                                                         MannequinLimb::leg},
                    std::vector<Limb> others = {});

// The wanted edge length of its mesh near a point [m].
double mannequin_edge(const Vec3&);

}  // namespace selvedge
