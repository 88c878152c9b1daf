#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Fronts that spread over a surface's vertices along its edges, but not along those that are shut, all at the same
// pace, so that small parts are whole before a large one is (Baraff et al. 2003 with the lockstep of Liao et al. 2024,
// section 3.2.3). Fronts that meet become one. The number of a front is the lowest of those that it came of.
class LockstepFlood {
 public:
  // `owner` is -1 for each vertex, and is so again when the flood is over: memory that floods share.
  LockstepFlood(const Surface& surface, const std::vector<char>& shut, std::vector<int>& owner)
      : surface_(surface), shut_(shut), owner_(owner) {}
  ~LockstepFlood();
  LockstepFlood(const LockstepFlood&) = delete;
  LockstepFlood& operator=(const LockstepFlood&) = delete;

  int add_front();
  void seed(int vertex, int front);
  void join(int a, int b);
  // Until at most `open` fronts have vertices left to go on from. Returns one that has, or -1.
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

}  // namespace selvedge
