#pragma once

#include <string>
#include <vector>

#include "pipeline/implicit_form.hpp"

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

// The body's surface.
Form mannequin_form();

// Edge length that its mesh is to have round a point [m].
double mannequin_edge(const Vec3&);

}  // namespace selvedge
