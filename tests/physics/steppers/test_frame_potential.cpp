#include <catch2/catch.hpp>

#include <limits>

#include "physics/steppers/frame_potential.hpp"
#include "tests/collision/solids.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_frame_potential {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

// A sheet that has come to rest on a plate, which then slides by 4 mm in a frame.
World sheet_on_sliding_plate() {
  World w = testing::sheet_over_plate();
  w.state = testing::run(w, 12).state;
  w.drive.obstacles[0].rowwise() += Eigen::RowVector3d(4e-3, 0, 0);
  return w;
}

ConventionalOptions closely() {
  ConventionalOptions options;
  options.substeps = 1;
  options.implicit_euler.velocity_tolerance = options.implicit_euler.relative_tolerance = 1e-6;
  options.implicit_euler.linear_tolerance = 1e-3;
  options.implicit_euler.max_newton = 100;
  return options;
}

double slope_at(FramePotential& potential, const Points& x) {
  Points gradient = Points::Zero(x.rows(), 3);
  potential.lag(x);
  potential.at(x, &gradient);
  return gradient.norm();
}

}  // namespace

TEST_CASE("frame potential: the gradient is that of the value, with contact and friction", "[frame_potential]") {
  const World w = sheet_on_sliding_plate();
  FramePotential potential(w.scene);
  REQUIRE(potential.begin(w.state, w.drive, dt));
  REQUIRE(potential.contacts() > 5);
  Points x = w.state.x + 3e-4 * Points::Random(w.state.x.rows(), 3);
  x.col(1).array() -= 5e-4;  // into the plate
  const double without_friction = potential.at(x, nullptr);
  potential.lag(x);
  CHECK(potential.at(x, nullptr) > without_friction);
  Points gradient = Points::Zero(x.rows(), 3), numeric = gradient;
  potential.at(x, &gradient);
  constexpr double h = 1e-7;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Points up = x, down = x;
    up.data()[i] += h;
    down.data()[i] -= h;
    numeric.data()[i] = (potential.at(up, nullptr) - potential.at(down, nullptr)) / (2 * h);
  }
  CHECK((gradient - numeric).cwiseAbs().maxCoeff() < 1e-4 * gradient.cwiseAbs().maxCoeff());

  Points twice = gradient;
  potential.at(x, &twice);
  CHECK((twice - 2 * gradient).norm() < 1e-12 * gradient.norm());
}

TEST_CASE("frame potential: the solver's frame is nearly its minimum", "[frame_potential]") {
  const World w = sheet_on_sliding_plate();
  State to;
  REQUIRE(make_conventional_stepper(w.scene, closely())->step(w.state, w.drive, dt, to).status == StepStatus::accepted);
  CHECK((to.x - w.state.x).col(0).mean() > 1e-3);  // the plate takes the sheet along
  FramePotential potential(w.scene);
  REQUIRE(potential.begin(w.state, w.drive, dt));
  CHECK(slope_at(potential, to.x) < 0.1 * slope_at(potential, w.state.x));
  potential.lag(to.x);
  const double least = potential.at(to.x, nullptr);
  for (int k = 0; k < 5; ++k) CHECK(potential.at(to.x + 3e-4 * Points::Random(to.x.rows(), 3), nullptr) > least);
}

TEST_CASE("frame potential: without contact the solver's frame is its minimum, and pins have no slope",
          "[frame_potential]") {
  World w = testing::make_world(testing::sheet(5, 0.2, 1));
  w.scene.pins = {0, 4};
  w.drive = at_rest(w.scene, w.state);
  w.drive.acceleration = {0, -9.81, 0};
  w.drive.pins.rowwise() += Eigen::RowVector3d(0, 0, 2e-3);
  State to;
  REQUIRE(make_conventional_stepper(w.scene, closely())->step(w.state, w.drive, dt, to).status == StepStatus::accepted);
  FramePotential potential(w.scene);
  REQUIRE(potential.begin(w.state, w.drive, dt));
  CHECK(potential.contacts() == 0);
  CHECK(slope_at(potential, to.x) < 1e-4 * slope_at(potential, w.state.x));
  Points gradient = Points::Zero(to.x.rows(), 3);
  potential.at(w.state.x, &gradient);
  CHECK(gradient.row(0).isZero(0));
}

TEST_CASE("frame potential: it depends on the frame alone, and says where there is none", "[frame_potential]") {
  const World w = sheet_on_sliding_plate();
  World other = w;
  other.state.x.col(1).array() += 0.03;
  other.drive.obstacles[0].rowwise() += Eigen::RowVector3d(0, 0.02, 0);
  const auto value = [&](FramePotential& potential, const World& world) {
    REQUIRE(potential.begin(world.state, world.drive, dt));
    const Points x = world.state.x.array() - 2e-4;
    potential.lag(x);
    return potential.at(x, nullptr);
  };
  FramePotential fresh(w.scene), used(w.scene);
  const double first = value(fresh, w);
  CHECK(value(used, other) != first);
  CHECK(value(used, w) == first);
  World bad = w;
  bad.state.x(0, 0) = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(used.begin(bad.state, bad.drive, dt));
  CHECK(value(used, w) == first);
}

TEST_CASE("frame potential: cloth that starts in a body is drawn out of it", "[frame_potential]") {
  World w = testing::sheet_over_plate();
  w.scene.obstacles.clear();
  w.state.obstacles.clear();
  w.drive.obstacles.clear();
  const testing::Solid block = testing::block(Vec3(-0.3, -0.2, -0.3), Vec3(0.3, 0.051, 0.3), 2);
  testing::add_obstacle(w, {block.x, block.surface.triangles});  // the sheet is 1 mm inside
  w.state.clean = false;
  FramePotential potential(w.scene);
  REQUIRE(potential.begin(w.state, w.drive, dt));
  Points gradient = Points::Zero(w.state.x.rows(), 3);
  potential.at(w.state.x, &gradient);
  CHECK(gradient.col(1).maxCoeff() < 0);  // up is downhill for all vertices
}

}  // namespace selvedge::test_frame_potential
