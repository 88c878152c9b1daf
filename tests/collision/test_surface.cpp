#include <catch2/catch.hpp>

#include "collision/surface.hpp"

using namespace selvedge;

TEST_CASE("surface: two triangles share one edge", "[surface]") {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 2, 1, 3;
  const Surface s = make_surface(5, triangles);
  CHECK(s.edges.rows() == 5);
  CHECK(s.isolated_vertices == 1);
  CHECK(s.component_count == 2);
  CHECK(s.nonmanifold_edges == 0);
  CHECK_FALSE(is_closed(s));
  const auto loops = boundary_loops(s);
  REQUIRE(loops.size() == 1);
  CHECK(loops[0].size() == 4);
  for (int t = 0; t < 2; ++t)
    for (int k = 0; k < 3; ++k) {
      const auto edge = s.edges.row(s.triangle_edges(t, k));
      const int a = triangles(t, k), b = triangles(t, (k + 1) % 3);
      CHECK(edge(0) == std::min(a, b));
      CHECK(edge(1) == std::max(a, b));
    }
}

TEST_CASE("surface: a tetrahedron is closed and a fan of three is not manifold", "[surface]") {
  Triangles closed(4, 3);
  closed << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  CHECK(is_closed(make_surface(4, closed)));
  CHECK(boundary_loops(make_surface(4, closed)).empty());
  Triangles fan(3, 3);
  fan << 0, 1, 2, 0, 1, 3, 0, 1, 4;
  CHECK(make_surface(5, fan).nonmanifold_edges == 1);
}
