#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/contour/buried.hpp"
#include "collision/exact/inside.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_buried {

using testing::join;
using testing::Sheet;

namespace {

// A closed ring round the y axis, oriented outwards: middle circle of radius 1, thickness 2 * `thin`.
Sheet ring(double thin, const Vec3& centre) {
  const int along = 48, round = 16;
  Sheet s;
  s.x.resize(along * round, 3);
  s.triangles.resize(2 * along * round, 3);
  const auto at = [&](int i, int j) { return i % along * round + j % round; };
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < round; ++j) {
      const double a = 2 * std::numbers::pi * i / along, b = 2 * std::numbers::pi * j / round;
      const double out = 1 + thin * std::cos(b);
      s.x.row(at(i, j)) = (centre + Vec3(out * std::cos(a), thin * std::sin(b), out * std::sin(a))).transpose();
      const int t = 2 * at(i, j);
      s.triangles.row(t) << at(i, j), at(i, j + 1), at(i + 1, j);
      s.triangles.row(t + 1) << at(i + 1, j), at(i, j + 1), at(i + 1, j + 1);
    }
  return s;
}

std::vector<char> buried(const Sheet& s) {
  const Surface surface = make_surface(static_cast<int>(s.x.rows()), s.triangles);
  const std::vector<SheetView> view{{&surface, &s.x}};
  return buried_vertices(surface, s.x, find_segments(view));
}

std::vector<char> inside(const Sheet& body, const Points& points) {
  return inside(make_surface(static_cast<int>(body.x.rows()), body.triangles), body.x, points);
}

// Vertices of triangles that cross, alone.
std::vector<char> crossing(const Sheet& s) {
  const Surface surface = make_surface(static_cast<int>(s.x.rows()), s.triangles);
  const std::vector<SheetView> view{{&surface, &s.x}};
  std::vector<char> marked(static_cast<std::size_t>(s.x.rows()), 0);
  for (const Segment& segment : find_segments(view).segments)
    for (const int t : segment.triangle)
      for (const int v : s.triangles.row(t)) marked[v] = 1;
  return marked;
}

std::vector<char> buried_faces(const Sheet& s) {
  const Surface surface = make_surface(static_cast<int>(s.x.rows()), s.triangles);
  const std::vector<SheetView> view{{&surface, &s.x}};
  return buried_triangles(surface, s.x, find_segments(view));
}

// Every vertex that lies in another part is buried, and of the others those of crossing triangles alone.
void check_parts(const std::vector<Sheet>& parts) {
  Sheet all = parts[0];
  for (std::size_t p = 1; p < parts.size(); ++p) all = join(all, parts[p]);
  std::vector<char> expected = crossing(all);
  const auto crossing_count = std::ranges::count(expected, 1);
  for (const Sheet& body : parts) {
    const std::vector<char> in = inside(body, all.x);
    for (std::size_t v = 0; v < in.size(); ++v) expected[v] = expected[v] || in[v];
  }
  REQUIRE(std::ranges::count(expected, 1) > crossing_count);
  REQUIRE(std::ranges::count(expected, 0) > 100);
  CHECK(buried(all) == expected);
  all.triangles.col(0).swap(all.triangles.col(1));  // oriented inwards
  CHECK(buried(all) == expected);
}

}  // namespace

TEST_CASE("buried: what lies in another part of the surface, however many overlap", "[buried]") {
  const Sheet thick = ring(0.3, {0, 0, 0}), other = ring(0.28, {0.9, 0.013, 0.007});
  check_parts({thick, other});
  check_parts({thick, other, ring(0.29, {0.47, 0.05, 0.81})});
  check_parts({thick, ring(0.1, {0.011, 0.02, 0.007}), other});  // one within the other, and not a crossing
}

TEST_CASE("buried: nothing where nothing crosses", "[buried]") {
  const std::vector<char> none = buried(join(ring(0.3, {0, 0, 0}), ring(0.3, {0, 0.7, 0})));
  CHECK(std::ranges::count(none, 1) == 0);
}

TEST_CASE("buried: no triangle that faces the outside, and open shells bury nothing", "[buried]") {
  const Sheet thick = ring(0.3, {0, 0, 0}), other = ring(0.28, {0.9, 0.013, 0.007}),
              within = ring(0.1, {0.011, 0.02, 0});
  const Sheet all = join(join(thick, other), within);
  const std::vector<char> faces = buried_faces(all);
  const std::vector<char> in_thick = inside(thick, all.x), in_other = inside(other, all.x);
  const int first = static_cast<int>(thick.triangles.rows()), last = first + static_cast<int>(other.triangles.rows());
  for (int t = 0; t < all.triangles.rows(); ++t)
    for (const int v : all.triangles.row(t))
      if (faces[t]) CHECK((t < first ? in_other[v] : t < last ? in_thick[v] : in_thick[v] || in_other[v]));
  const std::vector<char> whole = buried_faces(join(thick, within));  // nothing crosses
  CHECK(std::ranges::count(whole, 1) == within.triangles.rows());
  Sheet open = thick;
  open.triangles.conservativeResize(open.triangles.rows() - 1, 3);
  Sheet open_other = other;
  open_other.triangles.conservativeResize(other.triangles.rows() - 1, 3);
  const std::vector<char> none = buried_faces(join(open, open_other));
  CHECK(std::ranges::count(none, 1) == 0);
}

TEST_CASE("winding numbers: how many parts a point is in, with their orientation", "[buried]") {
  const Sheet a = ring(0.3, {0, 0, 0}), b = ring(0.28, {0.9, 0.013, 0.007});
  Sheet both = join(a, b);
  Points points(4, 3);
  points << 5, 0, 0, -1, 0.01, 0.02, 0.45, 0.003, 0.87, 1.9, 0.02, 0.01;
  const auto winding = [&] {
    return winding_numbers(make_surface(static_cast<int>(both.x.rows()), both.triangles), both.x, points);
  };
  CHECK(winding() == std::vector<int>{0, 1, 2, 1});
  CHECK(inside(both, points) == std::vector<char>{0, 1, 1, 1});
  both.triangles.col(0).swap(both.triangles.col(1));
  CHECK(winding() == std::vector<int>{0, -1, -2, -1});
}

}  // namespace selvedge::test_buried
