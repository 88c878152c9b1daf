#pragma once

#include <array>
#include <span>
#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Flood fill from several fronts over a surface's vertices, along edges that are not shut. All fronts advance at the
// same pace, so that small parts are complete before a large one (Baraff et al. 2003 with the lockstep of Liao et al.
// 2024, section 3.2.3). Fronts that meet are merged, under the lowest of their numbers.
class LockstepFlood {
 public:
  // `owner` is memory that floods share: -1 for each vertex, and again -1 after the destructor.
  LockstepFlood(const Surface& surface, const std::vector<char>& shut, std::vector<int>& owner)
      : surface_(surface), shut_(shut), owner_(owner) {}
  ~LockstepFlood();
  LockstepFlood(const LockstepFlood&) = delete;
  LockstepFlood& operator=(const LockstepFlood&) = delete;

  int add_front();
  void seed(int vertex, int front);
  void join(int a, int b);
  // Spreads until at most `open` fronts have vertices left to go on from. Returns one of these fronts, or -1.
  int grow(int open);

  int root(int front);
  int front_of(int vertex) { return owner_[vertex] < 0 ? -1 : root(owner_[vertex]); }
  const std::vector<int>& reached(int root_front) const { return reached_[root_front]; }
  int count() const { return static_cast<int>(parent_.size()); }

 private:
  void reach(int vertex, int front);
  void expand(int front);

  const Surface& surface_;
  const std::vector<char>& shut_;
  std::vector<int>& owner_;
  std::vector<int> parent_;
  std::vector<std::vector<int>> waiting_, reached_;
};

// Colours 0 and 1 of the fronts, different for two that are joined, 0 at `start` (-1: none in particular); -1 for
// fronts that are joined to none. Empty if there is no such colouring.
std::vector<int> two_colours(int fronts, std::span<const std::array<int, 2>> joined, int start);

}  // namespace selvedge
