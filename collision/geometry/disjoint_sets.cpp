#include "collision/geometry/disjoint_sets.hpp"

#include <numeric>
#include <utility>

namespace selvedge {

DisjointSets::DisjointSets(int size) : parent_(static_cast<std::size_t>(size)), count_(size) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int DisjointSets::root(int member) {
  while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
  return member;
}

void DisjointSets::join(int a, int b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  if (a > b) std::swap(a, b);
  parent_[b] = a;
  --count_;
}

std::vector<int> DisjointSets::numbers() {
  std::vector<int> number(parent_.size());
  int next = 0;
  for (int member = 0; member < static_cast<int>(parent_.size()); ++member) {
    const int lowest = root(member);
    number[member] = lowest == member ? next++ : number[lowest];
  }
  return number;
}

}  // namespace selvedge
