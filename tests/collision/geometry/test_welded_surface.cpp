#include "collision/geometry/welded_surface.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

#include "collision/geometry/closed_shells.hpp"
#include "collision/geometry/same_places.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_welded_surface {

using testing::join;
using testing::Sheet;

namespace {

// A closed block, its faces cut in two.
Sheet block(const Vec3& low, double size) {
  Sheet s{Points(8, 3), Triangles(12, 3)};
  for (int v = 0; v < 8; ++v) s.x.row(v) = (low + size * Vec3(v & 1, v >> 1 & 1, v >> 2)).transpose();
  s.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3,
      7, 5;
  return s;
}

// Every face with corners of its own.
Sheet soup(const Sheet& s) {
  Sheet loose{Points(3 * s.triangles.rows(), 3), s.triangles};
  for (int t = 0; t < s.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      loose.x.row(3 * t + k) = s.x.row(s.triangles(t, k));
      loose.triangles(t, k) = 3 * t + k;
    }
  return loose;
}

std::optional<WeldedSurface> welded(const Sheet& s) {
  return welded_surface(make_surface(static_cast<int>(s.x.rows()), s.triangles), same_places(s.x));
}

int shells(const Surface& surface) { return static_cast<int>(std::ranges::count(closed_shells(surface), 1)); }

}  // namespace

TEST_CASE("welded surface: seams close, and vertices keep their numbers", "[welded_surface]") {
  const Sheet whole = block({0, 0, 0}, 1), loose = soup(whole);
  CHECK_FALSE(welded(whole));
  const auto w = welded(loose);
  REQUIRE(w);
  CHECK(is_closed(w->surface));
  CHECK(w->surface.vertex_count == 36);
  CHECK(w->surface.isolated_vertices == 28);
  CHECK(w->surface.triangles.rows() == 12);
  Points moved = loose.x;
  moved.row(0) << 5, 5, 5;
  hold_together(w->joined, moved);
  for (int v = 0; v < 36; ++v) CHECK((moved.row(v) == moved.row(w->joined[v])));
  const std::vector<char> closed = closed_shells(make_surface(36, loose.triangles));
  CHECK(std::ranges::count(closed, 1) == 0);
}

TEST_CASE("welded surface: no edge gets more than two faces", "[welded_surface]") {
  // Two blocks with a common edge in space: each closes by itself.
  const auto side = welded(soup(join(block({0, 0, 0}, 1), block({1, 1, 0}, 1))));
  REQUIRE(side);
  CHECK(side->surface.nonmanifold_edges == 0);
  CHECK(shells(side->surface) == 2);
  // Shells that are whole already do not grow together in a vertex.
  CHECK_FALSE(welded(join(block({0, 0, 0}, 1), block({1, 1, 1}, 1))));
}

TEST_CASE("welded surface: repeated faces are left out, their other sides are not", "[welded_surface]") {
  const Sheet whole = block({0, 0, 0}, 1);
  Sheet patch{whole.x, whole.triangles.topRows(4)};
  const auto copied = welded(join(whole, patch));
  REQUIRE(copied);
  CHECK(copied->surface.triangles == whole.triangles);
  CHECK(is_closed(copied->surface));
  patch.triangles.col(0).swap(patch.triangles.col(1));  // a sheet that lies on the block from within
  const Sheet lined = join(whole, patch);
  const auto w = welded(lined);
  const Surface surface = w ? w->surface : make_surface(static_cast<int>(lined.x.rows()), lined.triangles);
  CHECK(surface.triangles.rows() == 16);
  CHECK(surface.nonmanifold_edges == 0);
  CHECK(shells(surface) == 1);
}

TEST_CASE("same places: what comes apart in any frame is apart", "[welded_surface]") {
  Points first(5, 3), second(5, 3);
  first << 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0;
  second << 0, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0;
  CHECK(same_places(std::vector{first}) == std::vector<int>{0, 0, 0, 3, 3});
  CHECK(same_places(std::vector{first, second}) == std::vector<int>{0, 1, 1, 3, 3});
}

}  // namespace selvedge::test_welded_surface
