#pragma once

#include "collision/contact/node_pair.hpp"

namespace selvedge {

// Eight pairs in straight motion, side by side in single precision. A pair is the polygon of differences between points
// of its second primitive and of its first: a triangle f - v, or a parallelogram b - a. The pair's distance is that of
// the polygon from the origin.
struct PairLanes {
  static constexpr int width = 8;
  // The corners once round, by coordinate and pair, at the start and how they change until the end [m]. The last corner
  // of a triangle counts twice.
  alignas(32) float start[4][3][width], change[4][3][width];

  // The pair whose nodes start at x0 and move by these displacements.
  void set(int lane, const NodePair&, const Points& x0, const Points& displacements);
};

// Tests that leave out most pairs, for a distance [m]. They return one bit a pair, which is 1 only if it is proven in
// exact arithmetic; 0 says nothing. Bits and gaps of lanes that were not set mean nothing.
struct PairKernels {
  // The pair's distance at the start, less the longest change of a corner, is above `distance`. `gaps` get a lower
  // bound of each distance at the start, which is off by some millionths of the lengths involved [m].
  unsigned (*stays_away)(const PairLanes&, double distance, float* gaps);
  // A plane separates the primitives by more than `distance` during all of the motion.
  unsigned (*apart_all_the_way)(const PairLanes&, double distance);
};

// The kernels for this machine: with AVX2 where it has it, else without. Both give the same bits.
const PairKernels& pair_kernels();

}  // namespace selvedge
