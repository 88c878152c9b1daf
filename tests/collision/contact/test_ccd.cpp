#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "collision/contact/ccd.hpp"
#include "collision/geometry/distance.hpp"

namespace selvedge::test_ccd {

using Four = std::array<Vec3, 4>;

namespace {

double distance(PairKind kind, const Four& x) {
  const Closest c =
      kind == PairKind::vertex_face ? point_triangle(x[0], x[1], x[2], x[3]) : edge_edge(x[0], x[1], x[2], x[3]);
  return std::sqrt(c.squared_distance);
}

Four between(const Four& x0, const Four& x1, double time) {
  Four x;
  for (int i = 0; i < 4; ++i) x[i] = x0[i] + time * (x1[i] - x0[i]);
  return x;
}

Four random_points(std::mt19937& random, double size, const Vec3& centre = Vec3::Zero()) {
  std::uniform_real_distribution<double> at(-size, size);
  Four x;
  for (Vec3& p : x) p = centre + Vec3(at(random), at(random), at(random));
  return x;
}

Four shifted(const Four& x, const Vec3& by) {
  Four moved = x;
  for (Vec3& p : moved) p += by;
  return moved;
}

constexpr PairKind both[] = {PairKind::vertex_face, PairKind::edge_edge};

}  // namespace

TEST_CASE("ccd: never late and rarely early on random motions, from 1e-3 to 1e3", "[ccd]") {
  std::mt19937 random(1);
  int hits = 0, early = 0, total = 0;
  for (double size : {1e-3, 1.0, 1e3})
    for (double separation : {0.0, 0.02 * size})
      for (PairKind kind : both)
        for (int i = 0; i < 500; ++i) {
          const Four x0 = random_points(random, size);
          const Four x1 = random_points(random, size);
          if (distance(kind, x0) <= 1.001 * separation) continue;
          const auto time = time_of_contact(kind, x0, x1, separation);
          const double until = time ? *time : 1;
          REQUIRE(until >= 0);
          REQUIRE(until <= 1);
          constexpr int samples = 200;
          for (int s = 0; s < samples; ++s)  // strictly before the time found nothing is too near
            REQUIRE(distance(kind, between(x0, x1, until * s / samples)) >= separation);
          ++total;
          if (!time) continue;
          ++hits;
          const double there = distance(kind, between(x0, x1, until));
          REQUIRE(there >= separation * (1 - 1e-9));
          early += there > separation + 1e-6 * size;
        }
  INFO(hits << " hits of " << total << ", " << early << " early");
  CHECK(hits > total / 10);
  CHECK(early <= hits / 100);
}

TEST_CASE("ccd: known times", "[ccd]") {
  const Four start{Vec3(0.2, 1, 0.2), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
  Four end = start;
  end[0].y() = -1;
  CHECK(*time_of_contact(PairKind::vertex_face, start, end, 0) == Approx(0.5).epsilon(1e-12));
  CHECK(*time_of_contact(PairKind::vertex_face, start, end, 0.1) == Approx(0.45).epsilon(1e-12));
  end[0] = Vec3(0.2, 0.11, 0.2);
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, start, end, 0.1));
  end[0] = Vec3(0.2, 0.09, 0.2);
  CHECK(time_of_contact(PairKind::vertex_face, start, end, 0.1));

  const Four crossed{Vec3(-1, 1, 0), Vec3(1, 1, 0), Vec3(0, 0, -1), Vec3(0, 0, 1)};
  Four fallen = crossed;
  fallen[0].y() = fallen[1].y() = -3;
  CHECK(*time_of_contact(PairKind::edge_edge, crossed, fallen, 0) == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("ccd: common motion and sliding cost nothing", "[ccd]") {
  const Four x0{Vec3(0.2, 1e-3, 0.2), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, x0, shifted(x0, {50, -70, 20}), 0.9e-3));
  Four slid = x0;
  slid[0].x() = 100;
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, x0, slid, 0.99e-3, 2));
}

TEST_CASE("ccd: a pair that starts too near is reported only if it comes nearer", "[ccd]") {
  const Four x0{Vec3(0.2, 1e-3, 0.2), Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0, 0)};
  Four x1 = x0;
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, x0, x1, 2e-3));
  x1[0].y() = 5e-3;
  CHECK_FALSE(time_of_contact(PairKind::vertex_face, x0, x1, 2e-3));
  x1[0].y() = -1e-3;
  const auto time = time_of_contact(PairKind::vertex_face, x0, x1, 2e-3);
  REQUIRE(time);
  CHECK(*time > 0);
  CHECK(*time < 0.5);

  Four touching = x0;
  touching[0].y() = 0;
  CHECK(time_of_contact(PairKind::vertex_face, touching, x1, 0) == std::optional(0.0));
  CHECK(time_of_contact(PairKind::vertex_face, touching, x1, 1e-3) == std::optional(0.0));
}

TEST_CASE("ccd: degenerate primitives, far from the origin, and too few iterations", "[ccd]") {
  std::mt19937 random(2);
  const Vec3 far(1e6, -1e6, 3e5);
  for (PairKind kind : both)
    for (int i = 0; i < 500; ++i) {
      Four x0 = random_points(random, 1, far), x1 = random_points(random, 1, far);
      if (i % 2) x0[3] = x0[2], x1[3] = x1[2];
      const auto time = time_of_contact(kind, x0, x1, 1e-3);
      const auto hasty = time_of_contact(kind, x0, x1, 1e-3, 2);
      if (distance(kind, x0) <= 1e-3) continue;
      for (int s = 0; s < 50; ++s) REQUIRE(distance(kind, between(x0, x1, time.value_or(1) * s / 50)) >= 1e-3 - 1e-9);
      if (time) {
        REQUIRE(hasty);
        REQUIRE(*hasty <= *time);
      }
    }
}

TEST_CASE("ccd: an undefined position counts as contact at once", "[ccd]") {
  std::mt19937 random(3);
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (PairKind kind : both)
      for (int node = 0; node < 4; ++node) {
        const Four x0 = random_points(random, 1);
        Four x1 = x0;
        x1[node].y() = bad;
        CHECK(time_of_contact(kind, x0, x1, 1e-3) == std::optional(0.0));
      }
}

}  // namespace selvedge::test_ccd
