#pragma once

#include "collision/distance/wide_tree.hpp"

namespace selvedge {

// Both hold a point (relative to the tree's origin) against eight things, write an estimate of each squared distance
// [m2] and return one bit for each that is below `limit`. Of a box the estimate is a lower bound but for the rounding
// of floats; of a triangle it is off by at most a few millionths of the sizes at hand, and 0 where the triangle is too
// thin for floats. The caller's limit has room for that (`search_limit`). Places without a triangle may be marked.
struct WideKernels {
  unsigned (*boxes)(const WideTree::Node&, const float* at, float limit, float* squared);
  unsigned (*triangles)(const WideTree::Leaf&, const float* at, float limit, float* squared);
};

// For this machine: AVX2 where it has it. Both give the same bits.
const WideKernels& wide_kernels();

// What squared distances of the kernels have to be below, so that nothing nearer than `distance` [m] is lost. `reach`
// is the tree's extent plus the point's distance from the origin [m].
inline float search_limit(double distance, double reach) {
  const double limit = distance * (1 + 4e-5) + 8e-6 * reach;
  return static_cast<float>(limit * limit * (1 + 1e-6));
}

}  // namespace selvedge
