#include "pipeline/smpl_joints.hpp"

namespace selvedge {

const std::vector<int>& smpl_joint_parents() {
  static const std::vector<int> parents = {-1, 0, 0, 0,  1,  2,  3,  4,  5,  6,  7,  8,
                                           9,  9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};
  return parents;
}

}  // namespace selvedge
