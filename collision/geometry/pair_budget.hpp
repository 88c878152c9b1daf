#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "collision/geometry/error.hpp"

namespace selvedge {

// Pairs that a search among so many triangles may look at: 512 a triangle (a sheet that falls by twenty of its edges
// has 150), and 2^22 more for small scenes, where every pair may be near.
constexpr std::int64_t most_pairs(std::int64_t triangles) { return (std::int64_t{1} << 22) + 512 * triangles; }

// A search met more pairs than it may look at, and has no result. Steppers turn it into a rejected step; outside of a
// stepper it ends the command as any other error.
class TooManyPairs : public Error {
 public:
  TooManyPairs(std::int64_t most, std::int64_t triangles)
      : Error("more than " + std::to_string(most) + " pairs are near each other",
              "search among " + std::to_string(triangles) + " triangles",
              "look for vertices far from all others, for a wrong unit, and for triangles much longer than their "
              "neighbours") {}
};

// Counts the pairs that a search has looked at, on all threads together. If all of them are added, `exceeded` does not
// depend on the number of threads.
class PairBudget {
 public:
  explicit PairBudget(std::int64_t triangles) : triangles_(triangles), most_(most_pairs(triangles)) {}
  // False if the budget is spent: the search then ends.
  bool add(std::int64_t pairs) { return used_.fetch_add(pairs, std::memory_order_relaxed) + pairs <= most_; }
  bool exceeded() const { return used_.load(std::memory_order_relaxed) > most_; }
  // Throws TooManyPairs if it is exceeded.
  void check() const {
    if (exceeded()) throw TooManyPairs(most_, triangles_);
  }

 private:
  std::int64_t triangles_, most_;
  std::atomic<std::int64_t> used_ = 0;
};

}  // namespace selvedge
