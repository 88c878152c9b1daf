#include <catch2/catch.hpp>
#include <random>

#include "collision/contact/pair_lanes.hpp"
#include "collision/contact/pair_motion.hpp"

namespace selvedge::test_pair_lanes {

namespace {

// Eight random pairs of primitives with edges up to `size`, about as far apart, that move by about `moved` [m].
struct EightPairs {
  Points x0, x1;
  std::vector<NodePair> pairs;
  PairLanes lanes;
  std::array<float, PairLanes::width> gaps;

  EightPairs(std::mt19937& random, double size, double moved, double from_origin) : x0(32, 3), x1(32, 3) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < PairLanes::width; ++i) {
      const Vec3 drift = 20 * moved * any(), place = from_origin * any();
      pairs.push_back(
          {random() % 2 ? PairKind::vertex_face : PairKind::edge_edge, {4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3}});
      for (int k = 0; k < 4; ++k) {
        x0.row(4 * i + k) = (place + size * any()).transpose();
        // Some primitives are flat, thin, parallel or points.
        if (k > 0 && random() % 8 == 0) x0.row(4 * i + k) = x0.row(4 * i + k - 1);
        if (k == 3 && random() % 8 == 0) x0.row(4 * i + 3) = x0.row(4 * i + 1) + 1e-3 * x0.row(4 * i + 2);
        x1.row(4 * i + k) = x0.row(4 * i + k) + (drift + moved * any()).transpose();
      }
    }
    const Points displacements = x1 - x0;
    for (int i = 0; i < PairLanes::width; ++i) lanes.set(i, pairs[i], x0, displacements);
  }
  bool stays_away(int i, double distance) { return pair_kernels().stays_away(lanes, distance, gaps.data()) >> i & 1; }
  bool is_apart(int i, double distance) const { return pair_kernels().apart_all_the_way(lanes, distance) >> i & 1; }
  double gap(int i) const { return std::sqrt(closest(pairs[i], x0).squared_distance); }
};

}  // namespace

TEST_CASE("pair lanes: a pair is left out only where the exact tests leave it out, and most of these are",
          "[pair_lanes]") {
  std::mt19937 random(8);
  int away = 0, surely_away = 0, apart = 0, surely_apart = 0, met = 0, close = 0, all = 0;
  for (int turn = 0; turn < 6000; ++turn) {
    const double size = std::pow(10.0, -static_cast<double>(turn % 4)), distance = 0.05 * size;
    EightPairs eight(random, size, (turn % 3) * 0.1 * size, turn % 5);
    const PairMotion motion(eight.x0, eight.x0, eight.x1);
    for (int i = 0; i < PairLanes::width; ++i) {
      const NodePair& pair = eight.pairs[i];
      const bool stays = eight.stays_away(i, distance), passes = eight.is_apart(i, distance);
      const bool exact_away = !motion.may_come_within(pair, eight.gap(i), distance);
      const bool exact_apart = !time_of_contact(pair.kind, corners(pair, eight.x0), corners(pair, eight.x1), distance);
      away += exact_away;
      surely_away += stays;
      apart += exact_apart;
      surely_apart += passes;
      met += !exact_apart;
      all += eight.gap(i) > distance;
      close += eight.gap(i) > distance && eight.gaps[i] > 0.999 * eight.gap(i);
      if (stays) CHECK(exact_away);
      if (passes) CHECK(exact_apart);
      if (!(eight.gaps[i] <= eight.gap(i))) FAIL_CHECK("a gap is too large");
    }
  }
  CHECK(close > 0.99 * all);
  CHECK(met > 1000);
  CHECK(surely_away > 0.99 * away);
  CHECK(surely_apart > 0.9 * apart);
}

TEST_CASE("pair lanes: rounding proves no distance that a pair does not have", "[pair_lanes]") {
  std::mt19937 random(9);
  int proven = 0;
  for (int turn = 0; turn < 2000; ++turn) {
    EightPairs eight(random, 0.03, 0, turn % 5);
    for (int i = 0; i < PairLanes::width; ++i) {
      const double gap = eight.gap(i);
      CHECK_FALSE((eight.stays_away(i, (1 + 1e-9) * gap) || eight.is_apart(i, (1 + 1e-9) * gap)));
      proven += eight.stays_away(i, (1 - 1e-4) * gap);
    }
  }
  CHECK(proven > 12000);
}

TEST_CASE("pair lanes: distances near the limit, undefined and huge coordinates are left to the exact tests",
          "[pair_lanes]") {
  Points x(4, 3);
  x << 0, 0, 0, -1, 1, -1, 1, 1, -1, 0, 1, 1;
  const NodePair pair{PairKind::vertex_face, {0, 1, 2, 3}};
  PairLanes lanes{};
  std::array<float, PairLanes::width> gaps;
  const auto bits = [&](const Points& x1, double distance) {
    lanes.set(0, pair, x, x1 - x);
    return std::pair(pair_kernels().stays_away(lanes, distance, gaps.data()) & 1,
                     pair_kernels().apart_all_the_way(lanes, distance) & 1);
  };
  CHECK(bits(x, 0.999) == std::pair(1U, 1U));
  CHECK(bits(x, 1 - 1e-9) == std::pair(0U, 0U));
  CHECK(bits(x, 1) == std::pair(0U, 0U));
  for (const double wild : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    Points to = x;
    to(2, 0) = wild;
    CHECK(bits(to, 1e-3) == std::pair(0U, 0U));
  }
}

}  // namespace selvedge::test_pair_lanes
