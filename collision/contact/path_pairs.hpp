#pragma once

#include "collision/contact/contact_pairs.hpp"

namespace selvedge {

// The pairs near a motion from `start` to `end`, and how far apart they are at the start. Which pairs are listed beyond
// those that come near, and in which order, depends on what was asked before; what is made of them may not.
struct PathPairs {
  Points start, end;
  std::vector<NodePair> pairs;
  std::vector<double> gap;  // [m]
  double slack = 0;         // by which a motion may end elsewhere for the list to hold [m]
};

// Makes `path` good for the motion x0 -> x1: it lists every pair that comes within a thickness [m] on the way or at its
// ends. The list is kept as long as x1, and x0 unless it is the start, are within its slack of the end for which it was
// made: a displacement budget that saves the search where little moves. Where x0 is the start and few nodes end
// elsewhere, only what has such a node is searched for anew. True if everything was. Throws TooManyPairs
// (pair_budget.hpp), and then `path` is good for no motion.
bool update_pairs(PairSearch&, double thickness, const Points& x0, const Points& x1, PathPairs& path);

// Positions relative to those at which the gaps of a list were taken.
class PathMotion {
 public:
  PathMotion(const PathPairs&, const Points& x0, const Points& x1);  // keeps a reference to the list
  // False only if pair i stays farther apart than `distance` [m] while all nodes move straight from x0 to x1: its gap
  // cannot shrink by more than the largest difference of displacements between a node of one primitive and one of the
  // other, which on a straight motion is largest at an end.
  bool may_come_within(std::size_t i, double distance) const;

 private:
  const PathPairs& path_;
  Points from_, to_;  // displacements at both ends
  double rounding_;   // [m]
};

// The listed pairs that may be within `distance` [m] at x.
std::vector<NodePair> pairs_within(const PathPairs&, const Points& x, double distance);

}  // namespace selvedge
