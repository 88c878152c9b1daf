#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// The pairs near a motion from `start` to `end`, and how far apart they are at the start. Earlier calls decide the
// order, and which further pairs are listed that do not come near; results must not depend on either.
struct PathPairs {
  std::vector<char> marks;  // by node: only pairs with a marked one are listed; empty: all pairs
  Points start, end;
  std::vector<NodePair> pairs;
  std::vector<double> gap;  // [m]
  double slack = 0;         // how far from `end` nodes may end for the list to remain valid [m]
};

// Makes `path` valid for the motion x0 -> x1: it lists every pair that comes within `thickness` [m] during the motion.
// The list is kept while x1, and x0 unless it equals the start, are within `slack` of the end for which it was made;
// this saves the search where little moves. Where x0 is the start and few nodes end beyond the slack, only pairs with
// such a node are searched for anew. Returns true if all were. Throws TooManyPairs (pair_budget.hpp); `path` is then
// not valid for any motion.
bool update_pairs(PairSearch&, double thickness, const Points& x0, const Points& x1, PathPairs& path);

// A motion x0 -> x1 relative to the positions at which the gaps of a list were measured.
class PathMotion {
 public:
  PathMotion(const PathPairs&, const Points& x0, const Points& x1);  // keeps a reference to the list
  // False only if pair i stays farther apart than `distance` [m] while all nodes move straight from x0 to x1: its gap
  // shrinks by at most the largest difference of displacements between a node of one primitive and one of the other,
  // and on a straight motion this is largest at an end.
  bool may_come_within(std::size_t i, double distance) const;

 private:
  const PathPairs& path_;
  Points from_, to_;  // displacements at both ends; from_ is empty where there are none
  double rounding_;   // [m]
};

// The listed pairs that may be within `distance` [m] at x.
std::vector<NodePair> pairs_within(const PathPairs&, const Points& x, double distance);

}  // namespace selvedge
