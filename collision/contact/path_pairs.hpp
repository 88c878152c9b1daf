#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// The pairs near a motion from `start` to an end, and how far apart they are at the start. Earlier calls decide the
// order, and which further pairs are listed that do not come near; results must not depend on either.
struct PathPairs {
  std::vector<char> marks;  // by node: only pairs with a marked one are listed; empty: all pairs
  Points start;
  Points end;        // of all nodes, for the pairs with an obstacle
  Points cloth_end;  // of the cloth's vertices, for pairs of the cloth with itself
  std::vector<NodePair> pairs;
  std::vector<double> gap;  // a lower bound (PairSearch::find_near) [m]
  double slack = 0;         // half of how much farther apart at the end than the thickness listed pairs may be [m]
};

// Makes `path` valid for the motion x0 -> x1: it lists every pair that comes within `thickness` [m] during the motion.
// The list is kept while x1, and x0 unless it equals the start, differ little from the end for which it was made; this
// saves the search where little moves. The two nodes of a pair may stray from their ends by twice the slack in sum.
// Where obstacles end as they did, the cloth has all of it in pairs with them; in pairs with itself each has half.
// Where x0 is the start and few nodes stray farther, only pairs with such a node are searched for anew. Returns true if
// all pairs, or all of either kind, were. Throws TooManyPairs (pair_budget.hpp); `path` is then not valid for any
// motion.
bool update_pairs(PairSearch&, double thickness, const Points& x0, const Points& x1, PathPairs& path);

// The listed pairs that may be within `distance` [m] at x.
std::vector<NodePair> pairs_within(const PathPairs&, const Points& x, double distance);

}  // namespace selvedge
