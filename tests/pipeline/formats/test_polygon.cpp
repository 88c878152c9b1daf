#include <catch2/catch.hpp>

#include <numbers>
#include <set>

#include "pipeline/formats/mesh_obj.hpp"
#include "pipeline/formats/mesh_ply.hpp"
#include "pipeline/formats/polygon.hpp"

namespace selvedge::test_polygon {

namespace {

double signed_area(const std::vector<Vec3>& x, const std::array<int, 3>& t) {
  const auto at = [&](int k) { return x[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
  return 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).z();
}

double smallest_area(const std::vector<Vec3>& x) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& t : polygon_triangles(x)) smallest = std::min(smallest, signed_area(x, t));
  return smallest;
}

double whole_area(const std::vector<Vec3>& x) {
  double sum = 0;
  for (const auto& t : polygon_triangles(x)) sum += signed_area(x, t);
  return sum;
}

}  // namespace

TEST_CASE("Convex polygons are fanned from their first corner", "[polygon]") {
  const std::vector<std::array<int, 3>> fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  std::vector<Vec3> pentagon;
  for (int k = 0; k < 5; ++k) {
    const double angle = 2 * std::numbers::pi * k / 5;
    pentagon.emplace_back(std::cos(angle), std::sin(angle), 0.01 * k);
  }
  CHECK(polygon_triangles(pentagon) == fan);
}

TEST_CASE("Points on straight edges make no triangle without area", "[polygon]") {
  // From a point within an edge, from its end, all round, and three in a row.
  for (const std::vector<Vec3>& x : std::vector<std::vector<Vec3>>{
           {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 2, 0}},
           {{1, 0, 0}, {2, 0, 0}, {1, 2, 0}, {0, 0, 0}},
           {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
           {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {2, 9, 0}}}) {
    CHECK(polygon_triangles(x).size() == x.size() - 2);
    CHECK(smallest_area(x) > 0.1);
  }
}

TEST_CASE("Polygons that are not convex are cut inside", "[polygon]") {
  // An L, a star of ten corners and a comb, whose fans turn over.
  std::vector<Vec3> star, comb{{0, 0, 0}, {7, 0, 0}};
  for (int k = 0; k < 10; ++k) {
    const double angle = 2 * std::numbers::pi * k / 10, radius = k % 2 == 0 ? 0.3 : 1;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  for (int k = 7; k >= 0; --k) comb.emplace_back(k, k % 2 == 0 ? 1 : 5, 0);
  const std::vector<Vec3> corner{{1, 1, 0}, {1, 2, 0}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}};
  for (const auto& [x, area] : std::vector<std::pair<std::vector<Vec3>, double>>{
           {corner, 3}, {star, 10 * 0.5 * 0.3 * std::sin(std::numbers::pi / 5)}, {comb, 21}}) {
    CHECK(smallest_area(x) > 0);
    CHECK(whole_area(x) == Approx(area));
  }
}

TEST_CASE("Polygons that lie on each other are cut along the same diagonals", "[polygon]") {
  // A square and its back, with vertices of their own, from each corner; then another square.
  Points x(10, 3);
  x << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0;
  const auto places = [&](const Triangles& triangles, int polygon) {
    std::set<std::set<int>> found;
    for (int t : {2 * polygon, 2 * polygon + 1})
      found.insert({triangles(t, 0) % 4, triangles(t, 1) % 4, triangles(t, 2) % 4});
    return found;
  };
  for (int first = 0; first < 4; ++first) {
    INFO(first);
    std::vector<int> corners{0, 1, 2, 3};
    for (int k = 0; k < 4; ++k) corners.push_back(4 + (first + 3 * k) % 4);  // the other way round
    for (const int v : {1, 8, 9, 2}) corners.push_back(v);
    const Triangles cut = cut_polygons(x, corners, {0, 4, 8}).unaryExpr([&](int k) { return corners[k]; });
    CHECK(places(cut, 0) == places(cut, 1));
    for (int t : {2, 3})
      CHECK((row(x, cut(t, 1)) - row(x, cut(t, 0))).cross(row(x, cut(t, 2)) - row(x, cut(t, 0))).z() == -1);
    CHECK(cut.row(4) == Eigen::RowVector3i(1, 8, 9));
  }
}

TEST_CASE("A flat quad whose edges cross is cut as the one whose edges do not", "[polygon]") {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.05}, {0, 1, 0}};
  for (const std::array<std::size_t, 4>& order : {std::array<std::size_t, 4>{0, 1, 3, 2}, {1, 3, 2, 0}, {3, 1, 2, 0}}) {
    std::vector<Vec3> crossed;
    for (const std::size_t k : order) crossed.push_back(square[k]);
    const double area = whole_area(crossed);
    CHECK(std::abs(area) == Approx(1).margin(1e-12));
    for (const auto& t : polygon_triangles(crossed)) CHECK(signed_area(crossed, t) * area > 0.4);
  }
  // Folded ones, in space or in the plane, are no crossed ones.
  const std::vector<Vec3> tent{{0, 0, 0}, {1, 0.2, 0.3}, {1, 1, 0}, {0.2, 1, 0.3}},
      arrow{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
  CHECK(polygon_triangles(tent) == std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}});
  CHECK(smallest_area(arrow) > 0);
  CHECK(crossed_quads(Points::Zero(4, 3), {0, 1, 2, 3}, {0}) == 0);
}

TEST_CASE("A polygon without area, or of very many corners, still ends", "[polygon]") {
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 0, 0}};
  CHECK(polygon_triangles(line).size() == 3);
  CHECK(polygon_triangles(std::vector<Vec3>(7, Vec3(1, 2, 3))).size() == 5);
  std::vector<Vec3> zigzag;
  for (int k = 0; k < 5000; ++k) zigzag.emplace_back(k, k % 2, 0);
  CHECK(polygon_triangles(zigzag).size() == 4998);
}

TEST_CASE("Both mesh readers cut polygons so, with their texture vertices", "[polygon]") {
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nvt 0 0\nvt 0.5 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4 5/5\n";
  const Mesh a = parse_obj(obj, "a.obj");
  CHECK(a.triangles == a.uv_triangles);
  const Mesh b = parse_ply(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 0 0\n2 2 0\n0 2 0\n5 0 1 2 3 4\n",
      "a.ply");
  CHECK(a.triangles == b.triangles);
  for (Eigen::Index t = 0; t < 3; ++t) {
    const auto at = [&](int k) { return row(a.x, a.triangles(t, k)); };
    CHECK((at(1) - at(0)).cross(at(2) - at(0)).z() > 0.5);
  }
}

}  // namespace selvedge::test_polygon
