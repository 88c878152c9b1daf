#include "pipeline/bodies/smpl_joints.hpp"

#include <algorithm>

#include "pipeline/bodies/body_smpl.hpp"

namespace selvedge {

const std::vector<int>& smpl_joint_parents() {
  static const std::vector<int> parents = {-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                           9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};
  return parents;
}

std::vector<int> smpl_joints_among(const std::vector<std::string>& joints) {
  std::vector<int> found;
  for (const std::string& name : smpl_joint_names(smpl::joints)) {
    const auto at = std::find(joints.begin(), joints.end(), name);
    const bool hand = found.size() >= smpl::hand;
    found.push_back(at != joints.end() ? static_cast<int>(at - joints.begin()) : hand ? found[found.size() - 2] : -1);
  }
  return found;
}

}  // namespace selvedge
