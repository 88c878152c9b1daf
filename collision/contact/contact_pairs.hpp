#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/contact/contact_world.hpp"
#include "collision/contact/pair_lanes.hpp"
#include "collision/contact/search_part.hpp"

namespace selvedge {

struct Exemption;
class PairMotion;

// Distance in the rest shape of a pair of one cloth; infinite for any other, and where the world has no rest shape [m].
double rest_distance(const ContactWorld&, const NodePair&);

// Numbers of searches and of pairs whose boxes overlapped.
struct SearchTally {
  int searches = 0;
  std::int64_t candidates = 0;
};

// What one part of a search has found.
struct FoundPairs {
  std::vector<NodePair> pairs;
  std::vector<double> gap;                          // of each pair (find_near); empty if nobody asked for it [m]
  std::int64_t overlapping = 0;                     // pairs whose boxes overlap
  std::array<NodePair, PairLanes::width> untested;  // found, but not yet tested for coming near
  int untested_count = 0;

  void clear() {
    pairs.clear();
    gap.clear();
    overlapping = 0;
    untested_count = 0;
  }
};

// The kinds of pairs: of the cloth with itself, and of the cloth with obstacles.
enum class Among { all, cloth, obstacles };

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
  // The same, without pairs that cannot come within the radius by the motion of their nodes. `gap` gets lower bounds of
  // how far apart the others are at x0, to some millionths of the lengths involved [m]. Only pairs of the wanted kind
  // are found.
  void find_near(const Points& x0, const Points& x1, double radius, std::vector<NodePair>& pairs,
                 std::vector<double>& gap, const std::vector<char>& marks = {}, Among among = Among::all);
  // From now on searches leave these pairs out; null: none. Keeps the pointer.
  void leave_out(const Exemption* exemption) { left_out_ = exemption; }
  const ContactWorld& world() const { return world_; }
  const SearchTally& tally() const { return tally_; }

 private:
  void prepare(const Points& x0, const Points& x1, double radius, bool ends, const std::vector<char>& marks, Among);
  void fill(bool only_marked, Among);
  // `motion` null: all pairs with overlapping boxes, and no gaps.
  void collect(const Points& x0, const Points& x1, double radius, const PairMotion* motion,
               std::vector<NodePair>& pairs, std::vector<double>& gap, const std::vector<char>& marks, Among);

  const ContactWorld& world_;
  const Exemption* left_out_ = nullptr;
  SearchPart cloth_;
  std::vector<SearchPart> obstacles_;
  std::vector<FoundPairs> scratch_;
  SearchTally tally_;
};

}  // namespace selvedge
