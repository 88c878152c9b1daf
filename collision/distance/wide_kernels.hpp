#pragma once

#include "collision/distance/wide_tree.hpp"

namespace selvedge {

// Both compare a point (relative to the tree's origin) with eight boxes or triangles, write an estimate of each squared
// distance [m2] and return one bit for each that is below `limit`. For a box the estimate is a lower bound up to
// rounding of floats. For a triangle it is off by at most a few millionths of the lengths involved, and 0 where the
// triangle is too thin for floats. `search_limit` allows for that. Bits of places without a triangle may be set.
struct WideKernels {
  unsigned (*boxes)(const WideTree::Node&, const float* at, float limit, float* squared);
  unsigned (*triangles)(const WideTree::Leaf&, const float* at, float limit, float* squared);
};

// The kernels for this machine: with AVX2 where it has it, else without. Both give the same bits.
const WideKernels& wide_kernels();

// The `limit` for the kernels with which nothing nearer than `distance` [m] is missed. `reach` is the tree's extent
// plus the point's distance from the origin [m].
inline float search_limit(double distance, double reach) {
  const double limit = distance * (1 + 4e-5) + 8e-6 * reach;
  return static_cast<float>(limit * limit * (1 + 1e-6));
}

}  // namespace selvedge
