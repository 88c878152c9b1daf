#pragma once

#include <array>
#include <span>
#include <vector>

namespace selvedge {

// Broad phase of the audit; shares no code with the tree of the solver. Boxes are closed and kept in double as given.
struct ExactBox {
  std::array<double, 3> lo, hi;
};

// A region of space with the boxes that touch it. A pair of boxes belongs to the region that holds the lowest corner of
// what they have in common, so that each pair is met once.
struct Region {
  ExactBox bounds;  // half-open: lo <= p < hi
  std::vector<int> first, second;
};

// Halves space until few boxes are left in each region or halving stops to help. Regions without a possible pair, of
// two of `first` (where within_first) or of one of `first` and one of `second`, are left out.
std::vector<Region> bisect(std::span<const ExactBox> first, std::span<const ExactBox> second, bool within_first);

// Do boxes a and b overlap, and is this the region to which the pair belongs?
inline bool meet_in(const Region& region, const ExactBox& a, const ExactBox& b) {
  for (int k = 0; k < 3; ++k) {
    const double lo = a.lo[k] > b.lo[k] ? a.lo[k] : b.lo[k];
    if (lo > a.hi[k] || lo > b.hi[k] || lo < region.bounds.lo[k] || !(lo < region.bounds.hi[k])) return false;
  }
  return true;
}

}  // namespace selvedge
