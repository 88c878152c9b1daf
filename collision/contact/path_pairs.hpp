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

// The listed pairs that may be within `distance` [m] at x.
std::vector<NodePair> pairs_within(const PathPairs&, const Points& x, double distance);

}  // namespace selvedge
