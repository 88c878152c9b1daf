#pragma once

#include <string>
#include <vector>

namespace selvedge {

// The 24 joints of SMPL, the root first, in its order (Loper et al. 2015); SMPL+H and SMPL-X share the first 22.
const std::vector<std::string>& smpl_joint_names();

// Parents of these, each before its children; -1 for the root.
const std::vector<int>& smpl_joint_parents();

}  // namespace selvedge
