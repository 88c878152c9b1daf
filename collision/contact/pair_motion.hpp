#pragma once

#include <optional>

#include "collision/contact/node_pair.hpp"

namespace selvedge {

// The straight motion x0 -> x1 of all nodes, relative to the positions `at` where the gaps of pairs were measured.
class PairMotion {
 public:
  PairMotion(const Points& at, const Points& x0, const Points& x1);
  // False only if a pair with this gap [m] stays farther apart than `distance` [m] all the way: its gap shrinks by at
  // most the largest difference of displacements between a node of one primitive and one of the other, and on a
  // straight motion this is largest at an end.
  bool may_come_within(const NodePair&, double gap, double distance) const;

 private:
  Points from_, to_;  // displacements at both ends; from_ is empty where there are none
  double rounding_;   // [m]
};

// The gap [m] at x0 of a pair that may come within `distance` [m] on a motion that starts there; absent if it cannot.
// The gap of the boxes round its primitives excludes most pairs whose boxes round the motion overlap.
std::optional<double> gap_if_near(const PairMotion&, const NodePair&, const Points& x0, double distance);

}  // namespace selvedge
