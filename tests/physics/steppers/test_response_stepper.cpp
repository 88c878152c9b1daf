#include <catch2/catch.hpp>

#include <limits>

#include "physics/steppers/carried_stepper.hpp"
#include "physics/steppers/response_stepper.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_response_stepper {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

// A sheet that falls through the plate in one frame if nothing stops it.
World sheet_through_plate() {
  World w = testing::sheet_over_plate();
  w.state.v.col(1).setConstant(-3);
  return w;
}

}  // namespace

TEST_CASE("response stepper: what it proposes itself, it ends as `carried` does", "[response_stepper]") {
  World w = sheet_through_plate();
  w.drive.acceleration.setZero();
  State ours, theirs;
  const StepReport a = make_response_stepper(w.scene)->step(w.state, w.drive, dt, ours);
  const StepReport b = make_carried_stepper(w.scene)->step(w.state, w.drive, dt, theirs);
  REQUIRE(a.status == StepStatus::accepted);
  REQUIRE(b.status == StepStatus::accepted);
  CHECK(ours.x == theirs.x);
  CHECK(ours.v == theirs.v);
  CHECK(a.collision.impulses == b.collision.impulses);
  CHECK(a.collision.impulses > 0);
  CHECK(ours.x.col(1).minCoeff() > 0);  // above the plate
}

TEST_CASE("response stepper: it goes to the guess, pins to their places, and stops where nothing is finite",
          "[response_stepper]") {
  World w = testing::make_world(testing::sheet(5, 0.2, 1));
  w.scene.pins = {3};
  w.drive = at_rest(w.scene, w.state);
  w.drive.pins.array() += 0.01;
  Points guess = w.state.x.array() + 0.02;
  const auto stepper = make_response_stepper(w.scene);
  StepExtras extras;
  extras.guess = &guess;
  State to;
  REQUIRE(stepper->step(w.state, w.drive, dt, to, extras).status == StepStatus::accepted);
  CHECK(to.x.row(3) == w.drive.pins.row(0));
  CHECK(to.x.row(7) == guess.row(7));
  CHECK(to.v.row(7).isApprox(Eigen::RowVector3d::Constant(0.6), 1e-9));
  guess(0, 0) = std::numeric_limits<double>::infinity();
  const StepReport report = stepper->step(w.state, w.drive, dt, to, extras);
  CHECK(report.status == StepStatus::rejected);
  CHECK(report.reason == Reason::not_finite);
}

}  // namespace selvedge::test_response_stepper
