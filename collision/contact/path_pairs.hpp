#pragma once

#include "collision/contact/contact_pairs.hpp"
#include "collision/contact/pair_motion.hpp"

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
  double reach = 0;         // every pair that comes within it is listed [m]; more than the thickness asked for
};

// Makes `path` valid for the motion x0 -> x1: it lists every pair that comes within `thickness` [m] during the motion.
// The list is kept while x1, and x0 unless it equals the start, differ little from the end for which it was made; this
// saves the search where little moves. The two nodes of a pair may stray from their ends by reach - thickness in sum,
// so that a list made for another thickness serves as far as it reaches. Where obstacles end as they did, the cloth has
// all of it in pairs with them; in pairs with itself each has half. Where x0 is the start and few nodes stray farther,
// only pairs with such a node are searched for anew. Returns true if all pairs, or all of either kind, were. Throws
// TooManyPairs (pair_budget.hpp); `path` is then not valid for any motion.
bool update_pairs(PairSearch&, double thickness, const Points& x0, const Points& x1, PathPairs& path);

// Contact may push a vertex within this many thicknesses.
inline constexpr double contact_reach = 2;

// Whether listed pairs touch: are within `reach` at x0 or at x1. So a list that is valid for this reach and motion may
// have further pairs. Keeps references.
class TouchTest {
 public:
  TouchTest(const PathPairs&, double reach, const Points& x0, const Points& x1);
  bool operator()(std::size_t listed) const;

 private:
  const PathPairs& path_;
  double reach_;
  const Points &x0_, &x1_;
  PairMotion motion_;
};

// The listed pairs that may be within `distance` [m] at x.
std::vector<NodePair> pairs_within(const PathPairs&, const Points& x, double distance);

}  // namespace selvedge
