#pragma once

#include <vector>

namespace selvedge {

// The members 0 .. size - 1 in sets that only grow (union-find). Results do not depend on the order of the joins.
class DisjointSets {
 public:
  explicit DisjointSets(int size);  // each member a set of its own

  int root(int member);  // the lowest member of its set
  void join(int a, int b);
  int count() const { return count_; }  // of the sets
  std::vector<int> numbers();  // of each member's set, sets in the order of their lowest members: 0 .. count() - 1

 private:
  std::vector<int> parent_;  // of each member another one of its set, not higher than itself; of a root itself
  int count_;
};

}  // namespace selvedge
