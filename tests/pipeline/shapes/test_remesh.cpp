#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include "collision/geometry/surface.hpp"
#include "pipeline/shapes/implicit_form.hpp"
#include "pipeline/shapes/isosurface.hpp"
#include "pipeline/shapes/remesh.hpp"

namespace selvedge::test_remesh {

namespace {

constexpr double radius = 0.1;
double ball(const Vec3& p) { return p.norm() - radius; }
Vec3 onto_ball(const Vec3& p) { return radius * p.normalized(); }

double volume_of(const Shape& shape) {
  double sum = 0;
  for (const auto& t : shape.triangles.rowwise())
    sum += row(shape.x, t[0]).dot(row(shape.x, t[1]).cross(row(shape.x, t[2]))) / 6;
  return sum;
}

Surface surface_of(const Shape& shape) { return make_surface(static_cast<int>(shape.x.rows()), shape.triangles); }

int euler(const Surface& s) {
  return s.vertex_count - static_cast<int>(s.edges.rows()) + static_cast<int>(s.triangles.rows());
}

std::pair<double, double> edge_lengths(const Shape& shape) {
  double least = 1, most = 0;
  const Surface surface = surface_of(shape);
  for (const auto& edge : surface.edges.rowwise()) {
    const double length = (row(shape.x, edge[1]) - row(shape.x, edge[0])).norm();
    least = std::min(least, length);
    most = std::max(most, length);
  }
  return {least, most};
}

void check_boundary(const Shape& shape) {  // one loop, exactly in the plane x = 0
  const auto loops = boundary_loops(surface_of(shape));
  REQUIRE(loops.size() == 1);
  int in_plane = 0;
  for (int v = 0; v < shape.x.rows(); ++v) in_plane += shape.x(v, 0) == 0;
  CHECK(in_plane == static_cast<int>(loops[0].size()));
  for (const int v : loops[0]) CHECK(shape.x(v, 0) == 0);
  // No edge but the boundary's joins two of its vertices: the mirror image would have the same edge.
  const Surface surface = surface_of(shape);
  for (int e = 0; e < surface.edges.rows(); ++e)
    if (shape.x(surface.edges(e, 0), 0) == 0 && shape.x(surface.edges(e, 1), 0) == 0)
      CHECK(surface.edge_triangles[static_cast<std::size_t>(e)][1] < 0);
}

}  // namespace

TEST_CASE("isosurface: a closed ball, and a half one with its boundary in the box's face") {
  const Shape whole = isosurface(ball, Vec3(-0.15, -0.15, -0.15), Vec3(0.15, 0.15, 0.15), 0.01);
  CHECK(is_closed(surface_of(whole)));
  CHECK(euler(surface_of(whole)) == 2);
  CHECK(volume_of(whole) == Approx(4.0 / 3 * std::numbers::pi * std::pow(radius, 3)).epsilon(0.01));
  double worst = 0;
  for (int v = 0; v < whole.x.rows(); ++v) worst = std::max(worst, std::abs(ball(row(whole.x, v))));
  CHECK(worst < 0.001);

  const Shape half = isosurface(ball, Vec3(0, -0.15, -0.15), Vec3(0.15, 0.15, 0.15), 0.01);
  CHECK(surface_of(half).nonmanifold_edges == 0);
  CHECK(euler(surface_of(half)) == 1);
  check_boundary(half);

  const Shape none = isosurface([](const Vec3&) { return 1.0; }, Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1), 0.01);
  CHECK(none.triangles.rows() == 0);
}

TEST_CASE("remesh: even triangles of the wanted size, on the surface, with the boundary kept") {
  const Shape rough = isosurface(ball, Vec3(0, -0.15, -0.15), Vec3(0.15, 0.15, 0.15), 0.01);
  for (const double wanted : {0.007, 0.02}) {
    INFO("edge " << wanted);
    const Shape even = remeshed(rough, {[&](const Vec3&) { return wanted; }, onto_ball}, 5);
    check_boundary(even);
    CHECK(surface_of(even).nonmanifold_edges == 0);
    CHECK(euler(surface_of(even)) == 1);
    const auto [least, most] = edge_lengths(even);
    CHECK(least > 0.6 * wanted);
    CHECK(most < 1.5 * wanted);
    CHECK(volume_of(even) > 0);
    for (int v = 0; v < even.x.rows(); ++v) CHECK(std::abs(ball(row(even.x, v))) < 1e-4);
    for (const auto& t : even.triangles.rowwise()) {
      const Vec3 a = row(even.x, t[0]), b = row(even.x, t[1]), c = row(even.x, t[2]);
      CHECK((b - a).cross(c - a).dot(a + b + c) > 0);
    }
  }
  // A blade, thinner than an edge: opposite sides of its boundary must not be joined.
  const Form blade = make_form({{{{Ellipsoid{{0, 0, 0}, {0.06, 0.008, 0.1}}}}}});
  const auto blade_value = [&](const Vec3& p) { return signed_value(blade, p); };
  const Shape thin =
      remeshed(isosurface(blade_value, Vec3(0, -0.05, -0.15), Vec3(0.1, 0.05, 0.15), 0.005),
               {[](const Vec3&) { return 0.02; }, [&](const Vec3& p) { return projected(blade, p); }}, 5);
  check_boundary(thin);
  CHECK(surface_of(thin).nonmanifold_edges == 0);
  CHECK(euler(surface_of(thin)) == 1);

  // Finer on one side.
  const auto graded = [](const Vec3& p) { return p.y() > 0 ? 0.008 : 0.02; };
  const Shape uneven = remeshed(rough, {graded, onto_ball}, 5);
  int above = 0;
  for (int v = 0; v < uneven.x.rows(); ++v) above += uneven.x(v, 1) > 0;
  CHECK(above > 3 * (uneven.x.rows() - above));
}

TEST_CASE("implicit form: distances of balls and cones, blends, cuts and mirror images") {
  const Form ball_form = make_form({{{{Ellipsoid{{0, 0, 0}, {0.1, 0.1, 0.1}}}}}});
  CHECK(signed_value(ball_form, {0.3, 0, 0}) == Approx(0.2));
  CHECK(signed_value(ball_form, {0, 0.05, 0}) == Approx(-0.05));

  const Form cone = make_form({{{{Cone{{0, 0, 0}, {0, 1, 0}, 0.2, 0.1}}}}});
  CHECK(signed_value(cone, {0.5, 0.5, 0}) == Approx(0.35));
  CHECK(signed_value(cone, {0, 1.3, 0}) == Approx(0.2));

  const Form egg = make_form({{{{Ellipsoid{{0, 0, 0}, {0.1, 0.2, 0.15}}}}}});
  const Vec3 on = projected(egg, {0.07, 0.12, 0.09});
  CHECK(on.cwiseQuotient(Vec3(0.1, 0.2, 0.15)).norm() == Approx(1).margin(1e-4));

  const Loft tube = make_loft(1, 0.1, 0.1, 2, {{0, -0.1, 0.1, -0.1, 0.1}, {1, -0.1, 0.1, -0.1, 0.1}});
  const Form capsule = make_form({{{{tube}}}});
  for (const Vec3& p : {Vec3(0.2, 0.3, 0), Vec3(0, 1.2, 0), Vec3(0, -0.2, 0), Vec3(0, 0.7, -0.2)})
    CHECK(signed_value(capsule, p) == Approx(0.1));

  Limb pair;
  pair.parts = {{Ellipsoid{{0, 0, 0}, {0.05, 0.05, 0.05}}},
                {Ellipsoid{{0.08, 0, 0}, {0.05, 0.05, 0.05}}, 0.04, true, false},
                {Ellipsoid{{0, 0.06, 0}, {0.03, 0.03, 0.03}}, 0.01, false, true}};
  const Form dumbbell = make_form({pair});
  const Form alone = make_form({{{pair.parts[0]}}});
  CHECK(signed_value(dumbbell, {-0.13, 0, 0}) == Approx(0).margin(1e-9));
  CHECK(signed_value(dumbbell, {0, 0.045, 0}) > 0);  // cut away
  CHECK(signed_value(dumbbell, {0.045, 0, 0.035}) < signed_value(alone, {0.045, 0, 0.035}) - 0.005);
  for (const Vec3& p : {Vec3(0.05, 0.02, 0.03), Vec3(0.02, 0.05, 0.01), Vec3(0.1, -0.02, 0.03)})
    CHECK(signed_value(dumbbell, p) == signed_value(dumbbell, Vec3(-p.x(), p.y(), p.z())));
}

}  // namespace selvedge::test_remesh
