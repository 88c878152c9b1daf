#include "collision/geometry/disjoint_sets.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

namespace selvedge::test_disjoint_sets {

TEST_CASE("disjoint sets go by their lowest member and are numbered in that order", "[disjoint_sets]") {
  DisjointSets sets(7);
  CHECK(sets.count() == 7);
  CHECK(sets.numbers() == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  sets.join(5, 2);
  sets.join(6, 3);
  sets.join(5, 6);
  sets.join(3, 2);  // they are together
  sets.join(4, 4);
  CHECK(sets.count() == 4);
  for (const int member : {2, 3, 5, 6}) CHECK(sets.root(member) == 2);
  CHECK(sets.root(4) == 4);
  CHECK(sets.numbers() == std::vector<int>{0, 1, 2, 2, 3, 2, 2});
  CHECK(DisjointSets(0).numbers().empty());
}

TEST_CASE("disjoint sets are the same whatever the order of the joins", "[disjoint_sets]") {
  constexpr int size = 500;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> any(0, size - 1);
  std::vector<std::pair<int, int>> joins(300);
  for (auto& [a, b] : joins) a = any(random), b = any(random);
  // By their definition: the lowest member goes from one to the other until nothing changes.
  std::vector<int> lowest(size);
  for (int member = 0; member < size; ++member) lowest[member] = member;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : joins) {
      changed = changed || lowest[a] != lowest[b];
      lowest[a] = lowest[b] = std::min(lowest[a], lowest[b]);
    }
  }
  for (int order = 0; order < 3; ++order) {
    DisjointSets sets(size);
    for (const auto& [a, b] : joins) order == 1 ? sets.join(b, a) : sets.join(a, b);
    int roots = 0;
    for (int member = 0; member < size; ++member) {
      REQUIRE(sets.root(member) == lowest[member]);
      roots += lowest[member] == member;
    }
    CHECK(sets.count() == roots);
    CHECK(std::ranges::max(sets.numbers()) == roots - 1);
    std::ranges::shuffle(joins, random);
  }
}

}  // namespace selvedge::test_disjoint_sets
