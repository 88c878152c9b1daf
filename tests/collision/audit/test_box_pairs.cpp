#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

#include "collision/audit/box_pairs.hpp"

namespace selvedge::test_box_pairs {

namespace {

using Pairs = std::vector<std::pair<int, int>>;

// Boxes of many sizes on a lattice, so that sides often touch; some are points, and some are equal.
std::vector<ExactBox> boxes(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<ExactBox> made;
  for (int i = 0; i < count; ++i) {
    const int size = random() % 20 == 0 ? 12 : static_cast<int>(random() % 3);
    ExactBox box;
    for (int k = 0; k < 3; ++k) {
      box.lo[k] = static_cast<double>(random() % 24) - 12;
      box.hi[k] = box.lo[k] + (size > 0 ? static_cast<double>(random() % size) : 0.0);
    }
    made.push_back(random() % 50 == 0 && i > 0 ? made.back() : box);
  }
  return made;
}

Pairs by_all_pairs(const std::vector<ExactBox>& a, const std::vector<ExactBox>& b, bool one) {
  Pairs found;
  for (int i = 0; i < static_cast<int>(a.size()); ++i)
    for (int j = one ? i + 1 : 0; j < static_cast<int>(b.size()); ++j)
      if (overlap(a[i], b[j])) found.emplace_back(i, j);
  return found;
}

}  // namespace

TEST_CASE("box pairs: each pair that overlaps is visited once", "[box_pairs]") {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const std::vector<ExactBox> first = boxes(seed == 1 ? 3 : 700, seed), second = boxes(400, seed + 10);
    for (const bool within : {true, false}) {
      const BoxPairs pairs(first, second, within);
      AuditBudget budget(1000);
      Pairs self, other;
      for (int part = 0; part < pairs.parts(); ++part)
        pairs.visit(
            part, budget, [&](int a, int b) { self.emplace_back(std::minmax(a, b)); },
            [&](int a, int c) { other.emplace_back(a, c); });
      budget.check();
      std::ranges::sort(self);
      std::ranges::sort(other);
      CHECK(self == (within ? by_all_pairs(first, first, true) : Pairs()));
      CHECK(other == by_all_pairs(first, second, false));
    }
  }
}

TEST_CASE("box pairs: boxes with one centre, far and endless ones", "[box_pairs]") {
  std::vector<ExactBox> same;
  for (int i = 0; i < 100; ++i) same.push_back({{-1.0 - i, -1, -1}, {1.0 + i, 1, 1}});
  same.push_back(everywhere);
  for (const double far : {1e300, -1e300}) same.push_back({{far, far, far}, {far, far, far}});
  const BoxPairs pairs(same, {}, true);
  AuditBudget budget(1000);
  Pairs found;
  for (int part = 0; part < pairs.parts(); ++part)
    pairs.visit(
        part, budget, [&](int a, int b) { found.emplace_back(std::minmax(a, b)); }, [](int, int) {});
  std::ranges::sort(found);
  CHECK(found == by_all_pairs(same, same, true));
}

TEST_CASE("box pairs: a search ends where its budget is spent", "[box_pairs]") {
  const std::vector<ExactBox> same(4000, ExactBox{{0, 0, 0}, {1, 1, 1}});  // nearly 8 million pairs
  const BoxPairs pairs(same, {}, true);
  AuditBudget budget(4);
  std::int64_t visited = 0;
  for (int part = 0; part < pairs.parts(); ++part)
    pairs.visit(
        part, budget, [&](int, int) { ++visited; }, [](int, int) {});
  CHECK(visited < most_pairs(4) + 64 * (1 << 13));
  CHECK_THROWS_AS(budget.check(), TooManyPairs);
}

}  // namespace selvedge::test_box_pairs
