#include "physics/scene/scene_numbers.hpp"

#include <catch2/catch.hpp>

#include <functional>
#include <limits>

#include "collision/geometry/error.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"
#include "tests/refusal.hpp"

namespace selvedge::test_scene_numbers {

using Catch::Matchers::Contains;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

template <class Struct>
void check_every_field() {
  for (const NumberField<Struct>& field : number_fields<Struct>()) {
    INFO(field.name);
    for (const double value : {nan, inf, -inf, -1.0, 1e300}) {
      Struct wrong;
      wrong.*field.member = value;
      CHECK_THROWS_WITH(check_numbers(wrong, "here"),
                        Contains("here: " + std::string(field.name) + " is ") && Contains("allowed: "));
    }
  }
  CHECK_NOTHROW(check_numbers(Struct{}, "here"));
}

// What a scene with one thing wrong is refused with; empty: it is taken.
std::string refusal(const std::function<void(testing::World&)>& spoil) {
  testing::World w = testing::make_world(testing::sheet(2, 0.2, 0));
  add_obstacle(w, testing::sheet(2, 0.6, -0.1));
  spoil(w);
  return testing::refusal([&] {
    check_scene(w.scene);
    check_state(w.scene, w.state);
  });
}

}  // namespace

TEST_CASE("scene_numbers: every number of every struct is checked, by its name", "[scene_numbers]") {
  check_every_field<Material>();
  check_every_field<Elasticity>();
  check_every_field<ContactSettings>();
  check_every_field<Wind>();
  check_every_field<Spring>();
  Material weightless;
  weightless.density = 0;
  CHECK_THROWS_WITH(check_numbers(weightless, "m"), Contains("density is 0") && Contains("above 0"));
}

TEST_CASE("scene_numbers: Young's modulus and Poisson's ratio give the Lame coefficients of plane stress",
          "[scene_numbers]") {
  Material material;
  set_elasticity({1000, 0.3}, "m", material);
  CHECK(material.lame_mu == Approx(1000 / 2.6));
  CHECK(material.lame_lambda == Approx(300 / 0.91));
  for (const auto& [e, nu] : {std::pair{-1.0, 0.3}, {1000, 2}, {1000, 1}, {1000, -1}, {nan, 0.3}, {1000, nan}})
    CHECK_THROWS_AS(set_elasticity({e, nu}, "m", material), Error);
}

TEST_CASE("scene_numbers: a scene from arrays is checked as one from a file", "[scene_numbers]") {
  using World = testing::World;
  CHECK(refusal([](World&) {}).empty());
  CHECK_THAT(refusal([](World& w) { w.scene.cloths[0].material.density = -3; }),
             Contains("cloth `sheet`, material: density is -3"));
  CHECK_THAT(refusal([](World& w) { w.scene.contact.thickness = 200; }), Contains("contact: thickness is 200"));
  CHECK_THAT(refusal([](World& w) { w.scene.wind.drag = nan; }), Contains("wind: drag is nan"));
  CHECK_THAT(refusal([](World& w) { w.scene.pins = {3, 99}; }), Contains("pin 1: names vertex 99"));
  CHECK_THAT(refusal([](World& w) { w.scene.pins = {3, 3}; }), Contains("pin 1") && Contains("each once"));
  CHECK_THAT(refusal([](World& w) { w.scene.springs = {{0, -1, 0.1, 10}}; }), Contains("spring 0: names vertex -1"));
  CHECK_THAT(refusal([](World& w) { w.scene.springs = {{0, 1, 0.1, nan}}; }), Contains("spring 0: stiffness is nan"));
  CHECK_THAT(refusal([](World& w) { w.scene.rest(2, 1) = inf; }), Contains("rest positions") && Contains("row 2"));
  CHECK_THAT(refusal([](World& w) { w.scene.rest_triangle.pop_back(); }), Contains("rest shapes"));
  CHECK_THAT(refusal([](World& w) { w.scene.rest_triangle[1](0, 1) = nan; }), Contains("triangle 1"));
  CHECK_THAT(refusal([](World& w) { w.state.x(4, 0) = 1e18; }), Contains("x: is [1e+18") && Contains("row 4"));
  CHECK_THAT(refusal([](World& w) { w.state.v(4, 0) = nan; }), Contains("v: is not finite") && Contains("m/s"));
  CHECK_THAT(refusal([](World& w) { w.state.v.resize(2, 3); }), Contains("v: has 2 rows"));
  CHECK_THAT(refusal([](World& w) { w.state.obstacles[0](0, 2) = -1e9; }), Contains("obstacle `body`"));
}

TEST_CASE("scene_numbers: no stepper takes a scene or a time step that is none", "[scene_numbers]") {
  testing::World w = testing::make_world(testing::sheet(2, 0.2, 0));
  const auto stepper = testing::conventional(w.scene);
  State to;
  for (const double dt : {0.0, -1.0, nan, inf, 1e30}) {
    CHECK_FALSE(stepper->traits().accepts(dt));
    CHECK_THROWS_WITH(testing::frame(w.scene, *stepper, w.state, w.drive, dt, to), Contains("time step [s] is "));
  }
  w.scene.cloths[0].material.lame_mu = -1;
  CHECK_THROWS_WITH(testing::conventional(w.scene), Contains("lame_mu is -1"));
  CHECK_THROWS_WITH(first_state(w.scene, w.state.x), Contains("lame_mu is -1"));
}

}  // namespace selvedge::test_scene_numbers
