#include <catch2/catch.hpp>

#include <limits>

#include "collision/search/intersections.hpp"
#include "tests/collision/brute_force.hpp"
#include "tests/collision/tangles.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_intersections {

using testing::Pairs;
using testing::Tangle;
using testing::tangles;

namespace {

// By the audit's test: the tree asks another.
Pairs brute_self(const Tangle& m) { return testing::brute_self(m, testing::audit_sees_meet); }

Pairs tree_self(const Tangle& m, bool cull = true) {
  IntersectionCache cache;
  cache.cull = cull;
  return intersecting_pairs(m.surface, m.x, cache);
}

}  // namespace

TEST_CASE("intersections: the tree finds the pairs that brute force finds", "[intersections]") {
  int clean = 0, tangled = 0;
  for (const Tangle& m : tangles(12)) {
    INFO(m.name);
    const Pairs expected = brute_self(m);
    (expected.empty() ? clean : tangled) += 1;
    CHECK(tree_self(m) == expected);
    CHECK(tree_self(m, false) == expected);
  }
  CHECK(clean >= 6);
  CHECK(tangled >= 8);
}

TEST_CASE("intersections: a kept tree finds the same after any motion", "[intersections]") {
  for (Tangle m : tangles(8)) {
    INFO(m.name);
    IntersectionCache cache;
    const Points start = m.x;
    for (unsigned k = 0; k < 4; ++k) {
      m.x = start;
      testing::shake(m.x, k * k * 0.05, k);
      CHECK(intersecting_pairs(m.surface, m.x, cache) == brute_self(m));
    }
  }
}

TEST_CASE("intersections: of two surfaces", "[intersections]") {
  const std::vector<Tangle> all = tangles(7);
  int meeting = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Tangle &a = all[i], &b = all[(i + 5) % all.size()];
    INFO(a.name << ", " << b.name);
    const Pairs expected = testing::brute_cross(a, b, testing::audit_sees_meet);
    IntersectionCache cache_a, cache_b;
    meeting += !expected.empty();
    CHECK(intersecting_pairs(a.surface, a.x, cache_a, b.surface, b.x, cache_b) == expected);
  }
  CHECK(meeting > 6);
}

TEST_CASE("intersections: nothing, and undefined coordinates", "[intersections]") {
  IntersectionCache cache;
  CHECK(intersecting_pairs(make_surface(0, Triangles(0, 3)), Points(0, 3), cache).empty());
  Tangle m = tangles(8)[4];
  const double infinity = std::numeric_limits<double>::infinity();
  m.x(5, 1) = std::numeric_limits<double>::quiet_NaN();
  m.x(50, 0) = infinity;
  m.x(60, 2) = -infinity;
  Pairs expected;
  for (const auto& [i, j] : brute_self(tangles(8)[4])) {
    bool touched = false;
    for (const int v : {5, 50, 60})
      for (int k = 0; k < 3; ++k) touched |= m.surface.triangles(i, k) == v || m.surface.triangles(j, k) == v;
    if (!touched) expected.emplace_back(i, j);
  }
  CHECK(tree_self(m) == expected);
}

TEST_CASE("intersections: the quick test never parts triangles that meet", "[intersections]") {
  std::mt19937 random(8);
  std::uniform_int_distribution<int> at(-2, 2);
  std::uniform_real_distribution<double> scale(-30, 30), place(-1, 1);
  int apart = 0, wrong = 0;
  for (int i = 0; i < 40000; ++i) {
    // Touching and coplanar pairs on a lattice, on another scale, far from the origin and turned a little.
    std::array<Vec3, 6> p;
    for (Vec3& q : p) q = Vec3(at(random), at(random), i % 3 ? at(random) : 0);
    if (i % 2) {
      Mat3 turn;
      for (double& entry : turn.reshaped()) entry = place(random);
      const double size = std::exp2(scale(random));
      const Vec3 shift = 1e3 * Vec3(place(random), place(random), place(random));
      for (Vec3& q : p) q = size * (turn * q + shift);
    }
    const bool quick = surely_apart({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
    apart += quick;
    wrong += quick && testing::audit_sees_meet({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
  }
  CHECK(wrong == 0);
  CHECK(apart > 10000);
}

TEST_CASE("intersections: the quick test never parts a sliver from what touches its corner", "[intersections]") {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-1, 1), exponent(-56, -20), part(0, 1);
  const auto anywhere = [&] { return Vec3(place(random), place(random), place(random)); };
  int apart = 0, wrong = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vec3 far = i % 2 ? Vec3(20 * anywhere()) : Vec3(0, 0, 0);
    std::array<Vec3, 3> sliver{far + anywhere(), far + anywhere(), {}}, other;
    sliver[2] = sliver[0] + part(random) * (sliver[1] - sliver[0]) + std::exp2(exponent(random)) * anywhere();
    std::swap(sliver[i % 3], sliver[2]);
    other[0] = sliver[(i / 3) % 3];  // touches
    for (int k = 1; k < 3; ++k) other[k] = other[0] + anywhere();
    wrong += i % 4 < 2 ? surely_apart(sliver, other) : surely_apart(other, sliver);
    other[0] += 0.01 * anywhere();
    apart += surely_apart(sliver, other);
  }
  CHECK(wrong == 0);
  CHECK(apart > 1000);
}

TEST_CASE("intersections: the same for any number of threads", "[intersections][threads]") {
  const Tangle m = tangles(30)[3];
  std::vector<Pairs> found;
  for (int n : {1, 2, 3}) {
    with_threads(n, [&] { found.push_back(tree_self(m)); });
  }
  CHECK(!found[0].empty());
  CHECK(found[1] == found[0]);
  CHECK(found[2] == found[0]);
}

}  // namespace selvedge::test_intersections
