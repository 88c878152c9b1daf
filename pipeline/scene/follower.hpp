#pragma once

#include <array>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A vertex without mass, which goes with three others: sum weights_i x_i.
struct Follower {
  int vertex = 0;
  std::array<int, 3> of{};
  Vec3 weights = Vec3::Zero();
};

}  // namespace selvedge
