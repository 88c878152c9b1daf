#pragma once

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
  // From `at` to x1.
  const Points& displacements() const { return to_; }
  double rounding() const { return rounding_; }  // that displacements and distances may have, at most [m]

 private:
  Points from_, to_;  // displacements at both ends; from_ is empty where there are none
  double rounding_;   // [m]
};

}  // namespace selvedge
