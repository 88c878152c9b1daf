#pragma once

#include <vector>

namespace selvedge {

// Parents of SMPL's 24 joints (`smpl_joint_names(24)`), each before its children; -1 for the root.
const std::vector<int>& smpl_joint_parents();

}  // namespace selvedge
