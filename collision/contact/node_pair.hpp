#pragma once

#include <array>

#include "collision/contact/ccd.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge {

// Two primitives that share no vertex. Of two edges of the cloth the one with the lower nodes comes first.
struct NodePair {
  PairKind kind;
  std::array<int, 4> nodes;  // v, f0, f1, f2 | a0, a1, b0, b1
  auto operator<=>(const NodePair&) const = default;
};

// The positions of a pair's nodes, in their order. x: one row a node of the world.
std::array<Vec3, 4> corners(const NodePair&, const Points& x);
// The closest points of a pair's two primitives (distance.hpp).
Closest closest(PairKind, const std::array<Vec3, 4>& corners);
inline Closest closest(const NodePair& pair, const Points& x) { return closest(pair.kind, corners(pair, x)); }

}  // namespace selvedge
