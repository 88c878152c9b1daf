#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// One element's Hessian between two of its nodes [N/m], of elements that lie side by side (HingeLanes, MembraneLanes).
template <class Lanes>
Mat3 block_of(const Lanes& lanes, int pair, int lane) {
  Mat3 block;
  for (int k = 0; k < 9; ++k) block(k / 3, k % 3) = lanes.block[pair][k][lane];
  return block;
}

}  // namespace selvedge
