#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/contact/ccd.hpp"
#include "collision/contact/contact_world.hpp"
#include "collision/contact/search_part.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge {

struct Exemption;

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

// Distance in the rest shape of a pair of one cloth; infinite for any other, and where the world has no rest shape [m].
double rest_distance(const ContactWorld&, const NodePair&);

// Numbers of searches and of pairs found.
struct SearchTally {
  int searches = 0;
  std::int64_t candidates = 0;
};

// Finds vertex-face and edge-edge pairs that may come within `radius` of each other while all nodes move straight from
// x0 to x1; misses none. Every vertex and edge belongs to one triangle, so that each pair is found once (representative
// triangles, Curtis, Tamstorf and Manocha 2008). Holds trees, which are caches.
class PairSearch {
 public:
  explicit PairSearch(const ContactWorld&);  // keeps a reference
  // The order of pairs depends on earlier calls; the set of pairs does not. `pairs` is overwritten. If `marks` (by
  // node) is not empty, only pairs with a marked node are found. Throws TooManyPairs (pair_budget.hpp), and then
  // `pairs` is empty.
  void find(const Points& x0, const Points& x1, double radius, std::vector<NodePair>& pairs,
            const std::vector<char>& marks = {});
  // From now on `find` leaves these pairs out; null: none. Keeps the pointer.
  void leave_out(const Exemption* exemption) { left_out_ = exemption; }
  const ContactWorld& world() const { return world_; }
  const SearchTally& tally() const { return tally_; }

 private:
  void fill(bool only_marked);

  const ContactWorld& world_;
  const Exemption* left_out_ = nullptr;
  SearchPart cloth_;
  std::vector<SearchPart> obstacles_;
  PartLists<NodePair> scratch_;
  SearchTally tally_;
};

}  // namespace selvedge
