#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "collision/geometry/surface.hpp"
#include "pipeline/shapes/generate.hpp"
#include "pipeline/shapes/primitives.hpp"

namespace selvedge::test_generate {

namespace {

const double pi = std::numbers::pi;

double area_of(const Points& x, const Triangles& triangles) {
  double sum = 0;
  for (int t = 0; t < triangles.rows(); ++t) {
    const Vec3 a = row(x, triangles(t, 0)), b = row(x, triangles(t, 1)), c = row(x, triangles(t, 2));
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

double volume_of(const Points& x, const Triangles& triangles) {
  double sum = 0;
  for (int t = 0; t < triangles.rows(); ++t)
    sum += row(x, triangles(t, 0)).dot(row(x, triangles(t, 1)).cross(row(x, triangles(t, 2)))) / 6;
  return sum;
}

// Smallest and largest angle of all triangles [degrees].
std::pair<double, double> angles_of(const Points& x, const Triangles& triangles) {
  double least = 180, most = 0;
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = row(x, triangles(t, k));
      const Vec3 a = row(x, triangles(t, (k + 1) % 3)) - p, b = row(x, triangles(t, (k + 2) % 3)) - p;
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / pi;
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
  return {least, most};
}

int euler(const Surface& s) {
  return s.vertex_count - static_cast<int>(s.edges.rows()) + static_cast<int>(s.triangles.rows());
}

// Neighbouring triangles run through their common edge in opposite directions.
bool oriented(const Triangles& triangles) {
  std::set<std::pair<int, int>> seen;
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      if (!seen.emplace(triangles(t, k), triangles(t, (k + 1) % 3)).second) return false;
  return true;
}

std::vector<int> group(const Mesh& mesh, const std::string& name) {
  for (const auto& [known, vertices] : mesh.groups)
    if (known == name) return vertices;
  return {};
}

std::vector<int> sorted_boundary(const Mesh& mesh) {
  std::vector<int> all;
  for (const auto& loop : boundary_loops(make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles)))
    all.insert(all.end(), loop.begin(), loop.end());
  std::sort(all.begin(), all.end());
  return all;
}

Triangulation any_triangulation() {
  return GENERATE(Triangulation::one_diagonal, Triangulation::alternating, Triangulation::unstructured);
}

}  // namespace

TEST_CASE("Rectangles cover their area with upright triangles", "[generate]") {
  const Triangulation triangulation = any_triangulation();
  const auto [columns, rows] = GENERATE(table<int, int>({{2, 2}, {3, 2}, {2, 5}, {12, 9}, {30, 30}}));
  INFO(static_cast<int>(triangulation) << " " << columns << " x " << rows);
  const Mesh mesh = make_rectangle(Vec2(1.2, 0.7), columns, rows, {triangulation, 3});
  const Surface s = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
  CHECK(euler(s) == 1);
  CHECK(oriented(mesh.triangles));
  CHECK(s.isolated_vertices == 0);
  CHECK(s.nonmanifold_edges == 0);
  CHECK(area_of(mesh.x, mesh.triangles) == Approx(0.84));
  CHECK((vertex_normals(s, mesh.x).col(1).array() > 0.999).all());
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    const Vec3 a = row(mesh.x, mesh.triangles(t, 0)), b = row(mesh.x, mesh.triangles(t, 1));
    CHECK((b - a).cross(row(mesh.x, mesh.triangles(t, 2)) - a).y() > 0);
  }
  CHECK(sorted_boundary(mesh) == group(mesh, "boundary"));
  CHECK(row(mesh.x, group(mesh, "top_left")[0]).isApprox(Vec3(-0.6, 0, -0.35)));
  CHECK(row(mesh.x, group(mesh, "bottom_right")[0]).isApprox(Vec3(0.6, 0, 0.35)));
  if (triangulation != Triangulation::unstructured) CHECK(mesh.x.rows() == columns * rows);
}

TEST_CASE("Diagonals run one way or alternate", "[generate]") {
  const auto directions = [](Triangulation triangulation) {
    const Mesh mesh = make_rectangle(Vec2(1, 1), 5, 5, {triangulation});
    const Surface s = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
    int up = 0, down = 0;
    for (int e = 0; e < s.edges.rows(); ++e) {
      const Vec3 d = row(mesh.x, s.edges(e, 1)) - row(mesh.x, s.edges(e, 0));
      if (std::abs(d.x()) < 1e-9 || std::abs(d.z()) < 1e-9) continue;
      ++(d.x() * d.z() < 0 ? up : down);
    }
    return std::pair(up, down);
  };
  CHECK(directions(Triangulation::one_diagonal) == std::pair(16, 0));
  CHECK(directions(Triangulation::alternating) == std::pair(8, 8));
}

TEST_CASE("Unstructured meshes are irregular, of good triangles, and the same for the same seed", "[generate]") {
  const auto mesh = [](std::uint64_t seed) {
    return make_rectangle(Vec2(1, 1), 40, 40, {Triangulation::unstructured, seed});
  };
  const Mesh one = mesh(1), again = mesh(1), other = mesh(2);
  CHECK(one.x == again.x);
  CHECK(one.triangles == again.triangles);
  CHECK(one.x != other.x);
  const auto [least, most] = angles_of(one.x, one.triangles);
  CHECK(least > 20);
  CHECK(most < 130);
  const Surface s = make_surface(static_cast<int>(one.x.rows()), one.triangles);
  int six = 0;
  for (int v = 0; v < s.vertex_count; ++v) six += s.triangles_of(v).size() == 6;
  CHECK(six < 0.9 * s.vertex_count);
}

TEST_CASE("Discs and tubes have their shape", "[generate]") {
  const Triangulation triangulation = any_triangulation();
  SECTION("disc") {
    const int rings = GENERATE(1, 2, 12);
    const Mesh disc = make_disc(0.5, rings, {triangulation, 1});
    const Surface s = make_surface(static_cast<int>(disc.x.rows()), disc.triangles);
    CHECK(euler(s) == 1);
    CHECK(oriented(disc.triangles));
    CHECK(s.isolated_vertices == 0);
    // A regular polygon of 6 rings corners.
    CHECK(area_of(disc.x, disc.triangles) == Approx(3 * rings * 0.25 * std::sin(pi / (3 * rings))));
    CHECK(sorted_boundary(disc) == group(disc, "boundary"));
    CHECK((vertex_normals(s, disc.x).col(1).array() > 0.999).all());
    CHECK(angles_of(disc.x, disc.triangles).first > 15);
  }
  SECTION("tube") {
    const auto [around, rows] = GENERATE(table<int, int>({{6, 2}, {7, 3}, {40, 20}}));
    const Mesh tube = make_tube(0.2, 0.6, around, rows, {triangulation, 1});
    const Surface s = make_surface(static_cast<int>(tube.x.rows()), tube.triangles);
    CHECK(tube.x.rows() == around * rows);
    CHECK(euler(s) == 0);
    CHECK(oriented(tube.triangles));
    CHECK(boundary_loops(s).size() == 2);
    CHECK(sorted_boundary(tube) == group(tube, "boundary"));
    CHECK(group(tube, "top").size() == static_cast<std::size_t>(around));
    CHECK(tube.x(group(tube, "top")[0], 1) == Approx(0.3));
    const Points normals = vertex_normals(s, tube.x);
    for (int v = 0; v < s.vertex_count; ++v) {
      CHECK(Vec2(tube.x(v, 0), tube.x(v, 2)).norm() == Approx(0.2));
      CHECK(normals.row(v).dot(tube.x.row(v)) > 0);  // outward
    }
    if (around == 40) CHECK(angles_of(tube.x, tube.triangles).first > 15);
  }
}

TEST_CASE("Ribbons follow their line and keep its length", "[generate]") {
  const std::vector<LinePoint> straight{{Vec3(0, 1, 0), Vec3(0, 2, 0)}, {Vec3(0.5, 1, 0), Vec3(0, 2, 0)}};
  const Mesh flat = make_ribbon(straight, 0.1, 11, 3, {});
  CHECK(flat.x.col(1).isConstant(1));
  CHECK(flat.x.col(0).maxCoeff() == Approx(0.5));
  CHECK(area_of(flat.x, flat.triangles) == Approx(0.05));
  CHECK(group(flat, "start") == std::vector<int>{0, 11, 22});
  CHECK(flat.x.row(group(flat, "end")[1]).isApprox(Eigen::RowVector3d(0.5, 1, 0)));
  CHECK(flat.x(group(flat, "middle")[0], 0) == Approx(0.25));

  std::vector<LinePoint> ring;  // three quarters of a circle, the ribbon on edge and then lying flat
  for (int k = 0; k <= 24; ++k) ring.push_back({Vec3(std::cos(pi * k / 16), 0, -std::sin(pi * k / 16)), Vec3::Zero()});
  CHECK(line_length(ring) == Approx(1.5 * pi).epsilon(1e-3));
  for (LinePoint& point : ring) point.normal = point.at;
  CHECK(least_normal_angle(ring) > 1.3);
  const Mesh hoop = make_ribbon(ring, 0.2, 95, 5, {any_triangulation(), 3});
  CHECK(area_of(hoop.x, hoop.triangles) == Approx(0.3 * pi).epsilon(0.01));
  CHECK((hoop.x.col(0).array().square() + hoop.x.col(2).array().square()).sqrt().isApproxToConstant(1, 0.01));
  CHECK(hoop.x.col(1).maxCoeff() == Approx(0.1));
  CHECK(oriented(hoop.triangles));
  for (LinePoint& point : ring) point.normal = Vec3(1, 0, 0);
  CHECK(least_normal_angle(ring) < 0.05);
}

TEST_CASE("A T-shirt is one piece with four openings", "[generate]") {
  for (const double edge : {0.01, 0.02, 0.04, 0.5}) {
    TshirtShape shape;
    shape.edge = edge;
    const Mesh shirt = make_tshirt(shape);
    const Surface s = make_surface(static_cast<int>(shirt.x.rows()), shirt.triangles);
    CHECK(s.component_count == 1);
    CHECK(s.nonmanifold_edges == 0);
    CHECK(oriented(shirt.triangles));
    CHECK(boundary_loops(s).size() == 4);  // hem, neck, two cuffs
    CHECK(euler(s) == -2);                 // a sphere with four holes
    if (edge > 0.02) continue;
    const double front = 0.5 * 0.65 + 2 * 0.15 * 0.2;
    CHECK(area_of(shirt.x, shirt.triangles) == Approx(2 * front).epsilon(0.05));
    CHECK(shirt.x.col(2).maxCoeff() == Approx(0.02));
    CHECK(shirt.x.col(2).minCoeff() == Approx(-0.02));
    CHECK(angles_of(shirt.x, shirt.triangles).first > 40);
    for (const char* name : {"hem", "neck", "cuffs", "seams", "front", "back"}) CHECK_FALSE(group(shirt, name).empty());
  }
}

TEST_CASE("Primitives are closed, oriented outward and near their volume", "[primitives]") {
  const auto check = [](const Shape& shape, double volume, double area, double edge) {
    const Surface s = make_surface(static_cast<int>(shape.x.rows()), shape.triangles);
    CHECK(is_closed(s));
    CHECK(s.component_count == 1);
    CHECK(euler(s) == 2);
    CHECK(oriented(shape.triangles));
    CHECK(volume_of(shape.x, shape.triangles) == Approx(volume).epsilon(0.02));
    CHECK(area_of(shape.x, shape.triangles) == Approx(area).epsilon(0.02));
    double longest = 0;
    for (int e = 0; e < s.edges.rows(); ++e)
      longest = std::max(longest, (shape.x.row(s.edges(e, 0)) - shape.x.row(s.edges(e, 1))).norm());
    CHECK(longest < 1.5 * edge);
  };
  check(make_sphere(0.3, 0.03), 4 * pi / 3 * 0.027, 4 * pi * 0.09, 0.03);
  check(make_capsule(0.1, 0.5, 0.02), pi * 0.01 * 0.5 + 4 * pi / 3 * 0.001, 2 * pi * 0.1 * 0.7, 0.02);
  check(make_capsule(0.1, 0, 0.02), 4 * pi / 3 * 0.001, 4 * pi * 0.01, 0.02);
  check(make_box(Vec3(0.2, 0.3, 0.5), 0.05), 0.03, 2 * (0.06 + 0.15 + 0.1), 0.05);
  check(make_box(Vec3(1, 1, 1), 5), 1, 6, 5);
  const Shape plane = make_plane(Vec2(4, 2), 0.5);
  CHECK(area_of(plane.x, plane.triangles) == Approx(8));
  CHECK(angles_of(make_sphere(1, 0.1).x, make_sphere(1, 0.1).triangles).first > 40);
}

TEST_CASE("Lines turned round the axis are oriented outward, whichever way they run", "[primitives]") {
  const std::vector<Vec2> cone{{0, 0}, {0.2, 0}, {0, 0.6}}, ring{{0.2, 0}, {0.3, 0}, {0.3, 0.1}, {0.2, 0.1}};
  for (const bool backward : {false, true})
    for (const bool closed : {false, true}) {
      std::vector<Vec2> profile = closed ? ring : cone;
      if (backward) std::reverse(profile.begin(), profile.end());
      const Shape shape = make_revolution(profile, closed, 0.01);
      const Surface s = make_surface(static_cast<int>(shape.x.rows()), shape.triangles);
      CHECK(is_closed(s));
      CHECK(euler(s) == (closed ? 0 : 2));
      CHECK(oriented(shape.triangles));
      const double volume = closed ? pi * (0.09 - 0.04) * 0.1 : pi * 0.04 * 0.6 / 3;
      CHECK(volume_of(shape.x, shape.triangles) == Approx(volume).epsilon(0.02));
    }
  const Shape open = make_revolution({{0.1, 0}, {0.2, 0.3}}, false, 0.02);
  CHECK(boundary_loops(make_surface(static_cast<int>(open.x.rows()), open.triangles)).size() == 2);
}

TEST_CASE("Vertices of spheres lie on the sphere", "[primitives]") {
  for (const double edge : {5.0, 0.7, 0.1}) {
    const Shape sphere = make_sphere(0.8, edge);
    CHECK((sphere.x.rowwise().norm().array() - 0.8).abs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("rectangle: graded spacings grow geometrically and keep the size and the groups", "[generate]") {
  const Vec2 size(2, 1);
  Mesh mesh = make_rectangle(size, 9, 5, {});
  grade_rectangle(mesh, size, 9, 5, {1000, 10});
  CHECK(area_of(mesh.x, mesh.triangles) == Approx(2));
  CHECK(mesh.x.col(0).minCoeff() == Approx(-1));
  CHECK(mesh.x.col(0).maxCoeff() == Approx(1));
  const double first = mesh.x(1, 0) - mesh.x(0, 0), second = mesh.x(2, 0) - mesh.x(1, 0),
               last = mesh.x(8, 0) - mesh.x(7, 0);
  CHECK(last / first == Approx(1000));
  CHECK(second / first == Approx(std::pow(1000, 1.0 / 7)));
  const auto z = [&](int row) { return mesh.x(9 * row, 2); };  // rows go from the bottom, +z, to the top
  CHECK((z(0) - z(1)) / (z(3) - z(4)) == Approx(10));
}

}  // namespace selvedge::test_generate
