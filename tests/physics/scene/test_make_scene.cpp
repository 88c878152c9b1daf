#include "physics/scene/make_scene.hpp"

#include <catch2/catch.hpp>

#include "collision/geometry/error.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_make_scene {

using Catch::Matchers::Contains;

TEST_CASE("make_scene: cloths are numbered on end, with their own materials and metrics", "[make_scene]") {
  const testing::Sheet a = testing::sheet(1, 0.1, 0), b = testing::sheet(2, 0.2, 1);
  Material heavy;
  heavy.density = 1;
  const RestTriangle half = 2 * flatten({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Scene scene;
  CHECK(add_cloth(scene, a.x, a.triangles) == 0);
  CHECK(add_cloth(scene, b.x, b.triangles, heavy, "scarf", std::vector<RestTriangle>(8, half)) == 1);
  CHECK(scene.cloths[0].name == "cloth0");
  CHECK((scene.cloths[1].name == "scarf" && scene.cloths[1].material.density == 1));
  CHECK((scene.cloths[1].first_vertex == 4 && scene.cloths[1].vertex_count == 9));
  CHECK((scene.cloths[1].first_triangle == 2 && scene.cloths[1].triangle_count == 8));
  CHECK(scene.surface.vertex_count == 13);
  CHECK((scene.surface.triangles.bottomRows(8).array() - 4 == b.triangles.array()).all());
  CHECK(scene.rest.topRows(4) == a.x);
  CHECK(area(scene.rest_triangle[0]) == Approx(0.005));
  CHECK(area(scene.rest_triangle[9]) == Approx(2));
  CHECK(lumped_masses(scene).tail(9).sum() == Approx(16));
}

TEST_CASE("make_scene: a first state and a world at rest fit the scene", "[make_scene]") {
  const testing::Sheet a = testing::sheet(1, 0.1, 0), b = testing::sheet(2, 1, -1);
  Scene scene;
  add_cloth(scene, a.x, a.triangles);
  CHECK(add_obstacle(scene, 9, b.triangles) == 0);
  CHECK((scene.obstacles[0].name == "obstacle0" && !scene.obstacles[0].moving));
  scene.pins = {1, 3};
  const State state = first_state(scene, a.x, {b.x});
  CHECK((state.x == a.x && state.v.isZero(0) && state.obstacles[0] == b.x && state.frame == 0 && !state.clean));
  const Drive drive = at_rest(scene, state);
  CHECK((drive.pins.rows() == 2 && drive.pins.row(1) == a.x.row(3) && drive.obstacles[0] == b.x));
  CHECK(drive.acceleration.y() == -9.81);
  CHECK_THROWS_WITH(first_state(scene, b.x, {b.x}), Contains("9 vertices") && Contains("have 4"));
  CHECK_THROWS_AS(first_state(scene, a.x), Error);
  CHECK_THROWS_AS(first_state(scene, a.x, {a.x}), Error);
}

TEST_CASE("make_scene: a vertex without mass is refused, since it would hold the cloth", "[make_scene]") {
  testing::Sheet a = testing::sheet(1, 0.1, 0);
  a.x.conservativeResize(5, 3);
  a.x.row(4) = 0.5 * (a.x.row(0) + a.x.row(1));
  a.triangles.conservativeResize(a.triangles.rows() + 1, 3);
  a.triangles.bottomRows(1) << 0, 1, 4;
  Scene scene;
  add_cloth(scene, a.x, a.triangles, {}, "sheet");
  CHECK_THROWS_WITH(first_state(scene, a.x), Contains("cloth `sheet`") && Contains("vertex 4 has no mass"));
  scene.pins = {4};
  CHECK_NOTHROW(first_state(scene, a.x));
}

TEST_CASE("make_scene: arrays that do not fit are refused, and the scene stays as it is", "[make_scene]") {
  const testing::Sheet a = testing::sheet(1, 0.1, 0);
  Scene scene;
  Triangles wrong = a.triangles;
  wrong(1, 2) = 4;
  CHECK_THROWS_WITH(add_cloth(scene, a.x, wrong), Contains("triangle 1") && Contains("there are 4"));
  CHECK_THROWS_AS(add_obstacle(scene, 3, a.triangles), Error);
  wrong(1, 2) = wrong(1, 1);
  CHECK_THROWS_WITH(add_cloth(scene, a.x, wrong), Contains("twice"));
  CHECK_THROWS_AS(add_cloth(scene, a.x, a.triangles, {}, "", std::vector<RestTriangle>(3)), Error);
  Points broken = a.x;
  broken(0, 0) = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(add_cloth(scene, broken, a.triangles), Error);
  CHECK((scene.cloths.empty() && scene.surface.vertex_count == 0 && scene.obstacles.empty()));
}

}  // namespace selvedge::test_make_scene
