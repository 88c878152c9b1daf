#include <catch2/catch.hpp>

#include <cmath>

#include "collision/geometry/surface.hpp"

namespace selvedge::test_surface {

TEST_CASE("surface: two triangles share one edge", "[surface]") {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 2, 1, 3;
  const Surface s = make_surface(5, triangles);
  CHECK(s.edges.rows() == 5);
  CHECK(s.isolated_vertices == 1);
  CHECK(s.component_count == 2);
  CHECK(s.nonmanifold_edges == 0);
  CHECK_FALSE(is_closed(s));
  Points x(5, 3);
  x << 0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 2, 0, 9, 9, 9;
  CHECK(mean_edge(s, x) == Approx((4 * 2 + std::sqrt(8)) / 5));
  CHECK(mean_edge(make_surface(1, Triangles(0, 3)), Points::Zero(1, 3)) == 0);
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

TEST_CASE("surface: loops that meet at one vertex stay apart, and a hole has its own", "[surface]") {
  Triangles bow_tie(2, 3);
  bow_tie << 0, 1, 2, 2, 3, 4;
  const auto loops = boundary_loops(make_surface(5, bow_tie));
  REQUIRE(loops.size() == 2);
  CHECK(loops[0].size() == 3);
  CHECK(loops[1].size() == 3);

  Triangles ring(8, 3);  // square 0..3 round square 4..7
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    ring.row(2 * k) << k, next, k + 4;
    ring.row(2 * k + 1) << next, next + 4, k + 4;
  }
  const auto both = boundary_loops(make_surface(8, ring));
  REQUIRE(both.size() == 2);
  CHECK(both[0] == std::vector{0, 1, 2, 3});
  CHECK(both[1] == std::vector{4, 7, 6, 5});

  Triangles clashing(2, 3);
  clashing << 0, 1, 2, 1, 2, 3;
  CHECK(boundary_loops(make_surface(4, clashing)).empty());
}

TEST_CASE("surface: triangles round a vertex, owners and components", "[surface]") {
  Triangles triangles(3, 3);
  triangles << 4, 5, 6, 0, 1, 2, 2, 1, 3;
  const Surface s = make_surface(8, triangles);
  CHECK(std::vector(s.triangles_of(1).begin(), s.triangles_of(1).end()) == std::vector{1, 2});
  CHECK(s.triangles_of(7).empty());
  CHECK(s.vertex_owner == std::vector{1, 1, 1, 2, 0, 0, 0, -1});
  CHECK(s.component == std::vector{0, 0, 0, 0, 1, 1, 1, 2});
  CHECK(s.component_count == 3);
  for (int t = 0; t < 3; ++t)
    for (int k = 0; k < 3; ++k) {
      const int edge = s.triangle_edges(t, k), owner = s.edge_owner[edge];
      CHECK(owner <= t);
      CHECK((s.edge_triangles[edge][0] == t || s.edge_triangles[edge][1] == t));
      CHECK(s.edge_triangles[edge][0] == owner);
    }
}

TEST_CASE("surface: vertex normals weigh by area and point to the counter-clockwise side", "[surface]") {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 3, 1;
  const Surface s = make_surface(5, triangles);
  Points x(5, 3);
  x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 3, 9, 9, 9;  // areas 1/2 with normal z and 3/2 with normal y
  const Points normals = vertex_normals(s, x);
  CHECK(row(normals, 2).isApprox(Vec3(0, 0, 1)));
  CHECK(row(normals, 3).isApprox(Vec3(0, 1, 0)));
  CHECK(row(normals, 0).isApprox(Vec3(0, 3, 1).normalized()));
  CHECK(row(normals, 4).isZero());
}

}  // namespace selvedge::test_surface
