#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "collision/penetration/penetration_regions.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

namespace selvedge::test_closed_surface {

using namespace closed;

namespace {

Solid tube(int around, int count, double radius, double from, double to) {
  return rings(around, count, [=](int j, double angle) {
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), from + (to - from) * j / (count - 1));
  });
}

}  // namespace

TEST_CASE("closed surface: fans close the holes, and the mesh stays as it is", "[penetration]") {
  const Solid solid = tube(9, 4, 0.5, 0, 1);
  const ClosedSurface closed = close_surface(solid.surface());
  CHECK(closed.cloth_vertices == 36);
  CHECK(closed.loops.size() == 2);
  CHECK(closed.surface.triangles.topRows(solid.triangles.rows()) == solid.triangles);
  CHECK(closed.surface.triangles.rows() == solid.triangles.rows() + 18);
  CHECK(is_closed(closed.surface));
  CHECK(closed.orientable == std::vector<char>{1});
  CHECK(std::ranges::count(closed.turn, 1) == closed.surface.triangles.rows());
  const Points x = closed_positions(closed, solid.x);
  CHECK(std::abs(x.row(36).head<2>().norm()) < 1e-12);
  CHECK(std::abs(x(36, 2) - x(37, 2)) == Approx(1));

  Points gradient = Points::Random(38, 3), step = Points::Random(36, 3);
  const double by_cloth = by_cloth_positions(closed, gradient).cwiseProduct(step).sum();
  CHECK(by_cloth == Approx(gradient.cwiseProduct(closed_positions(closed, step)).sum()));
}

TEST_CASE("closed surface: named holes stay open", "[penetration]") {
  const Surface surface = tube(9, 4, 0.5, 0, 1).surface();
  const std::vector<int> bottom{3}, all{3, 30}, inner{12};
  CHECK(close_surface(surface, {}, bottom).loops.size() == 1);
  CHECK(close_surface(surface, {}, all).loops.empty());
  CHECK_THROWS_AS(close_surface(surface, {}, inner), Error);
  CHECK_THROWS_AS(close_surface(surface, inner), Error);
}

TEST_CASE("closed surface: triangles are turned alike where they can be", "[penetration]") {
  Solid solid = ball(1);
  for (int t = 0; t < solid.triangles.rows(); t += 3) solid.triangles.row(t).reverseInPlace();
  const ClosedSurface closed = close_surface(solid.surface());
  CHECK(closed.orientable == std::vector<char>{1});
  for (int t = 0; t < solid.triangles.rows(); ++t) CHECK((closed.turn[t] == closed.turn[0]) == (t % 3 == 0));

  // A strip whose ends are joined after half a turn.
  const int n = 12;
  Triangles strip(2 * n, 3);
  for (int i = 0; i < n; ++i) {
    const int a = 2 * i, b = a + 1, c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    strip.row(2 * i) << a, b, c;
    strip.row(2 * i + 1) << b, d, c;
  }
  CHECK(close_surface(make_surface(2 * n, strip)).orientable == std::vector<char>{0});
}

TEST_CASE("closed surface: a fan meets only its own garment", "[penetration]") {
  // A shirt that sticks out of a jacket at both ends, and a shirt whose own hem is lifted through its neck.
  const Solid shirt = tube(14, 9, 0.4, -1, 1), jacket = tube(11, 7, 0.5, -0.703, 0.711);
  const ClosedSurface closed = close_surface(both(shirt, jacket).surface());
  CHECK(closed.loops.size() == 4);
  const Points x = closed_positions(closed, both(shirt, jacket).x);
  CHECK(find_penetration(closed, x).contours.empty());

  std::vector<int> one(static_cast<std::size_t>(x.rows() - 4), 7);
  const ClosedSurface same = close_surface(both(shirt, jacket).surface(), one);
  CHECK_FALSE(find_penetration(same, closed_positions(same, both(shirt, jacket).x)).contours.empty());
}

}  // namespace selvedge::test_closed_surface
