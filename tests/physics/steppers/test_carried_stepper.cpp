#include <catch2/catch.hpp>

#include "physics/steppers/carried_stepper.hpp"
#include "physics/steppers/conventional_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_carried_stepper {

using testing::make_world;
using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

// The sheet's skinned target: `offset` [m] from where it starts.
Points moved(const World& world, const Vec3& offset) { return world.state.x.rowwise() + offset.transpose(); }

}  // namespace

TEST_CASE("carried: cloth goes along with its skinned target, and keeps a part of its motion relative to it",
          "[carried]") {
  World world = make_world(testing::sheet(5, 0.2, 1));
  world.drive.acceleration = {0, -9.81, 0};
  const auto stepper = make_carried_stepper(world.scene);
  State first, second, third;
  world.state.v.setConstant(0.3);
  world.drive.skinned_targets = moved(world, {0, 0, 0});
  REQUIRE(testing::frame(world.scene, *stepper, world.state, world.drive, dt, first).status == StepStatus::accepted);
  CHECK((first.x - moved(world, {0.01, 0.01, 0.01})).cwiseAbs().maxCoeff() < 1e-12);  // nothing is known of before
  world.drive.skinned_targets = moved(world, {0, 0, 0.02});
  testing::frame(world.scene, *stepper, first, world.drive, dt, second);
  CHECK((second.x - first.x).isApprox(moved(world, {0, 0, 0.02}) - world.state.x, 1e-12));
  Points pushed = second.x;
  pushed.col(0).array() += 0.01;  // as if it had moved so in the second frame
  for (MemoryBlock& block : second.memory)
    if (block.name == "carried.motion") block.rows.col(0).array() += 0.01;
  second.x = pushed;
  world.drive.skinned_targets = moved(world, {0, 0, 0.05});
  testing::frame(world.scene, *stepper, second, world.drive, dt, third);
  CHECK((third.x - pushed).isApprox(moved(world, {0.006, 0, 0.03}) - world.state.x, 1e-9));
}

TEST_CASE("carried: the default set gives the bits of the formula, and other sets give their sum", "[carried]") {
  World world = make_world(testing::sheet(4, 0.2, 1));
  world.drive.skinned_targets = moved(world, {0.013, 0.007, 0.003});
  State before = world.state, from = world.state;
  before.memory = carried_memory({}, world.drive, before.x);
  from.x = moved(world, {0.017, 0.011, 0.005});
  world.drive.skinned_targets = moved(world, {0.019, 0.007, 0.003});
  from.memory = carried_memory(before, world.drive, from.x, 2);
  const Points now = world.drive.skinned_targets, motion = *find_rows(from.memory, "carried.motion", 25);
  world.drive.skinned_targets = moved(world, {0.031, 0.002, 0.009});
  Points expected = from.x;
  for (Eigen::Index v = 0; v < expected.rows(); ++v) {
    expected.row(v) += world.drive.skinned_targets.row(v) - now.row(v);
    expected.row(v) += 0.6 * motion.row(v);
  }
  CHECK(carried_guess(world.scene, from, world.drive, dt) == expected);
  CarriedModel model;
  model.own = model.scene.transpose().replicate(25, 1);
  CHECK(carried_guess(world.scene, from, world.drive, dt, model) == expected);
  model.own(3, static_cast<int>(CarriedTerm::offset)) = -0.5;
  const Points guess = carried_guess(world.scene, from, world.drive, dt, model);
  CHECK((guess.row(3) - expected.row(3) + 0.5 * (from.x - now).row(3)).norm() < 1e-12);
  CHECK(guess.row(4) == expected.row(4));
}

TEST_CASE("carried: where memory lacks a frame that a model asks for, the default set steps", "[carried]") {
  World world = make_world(testing::sheet(5, 0.2, 1));
  CarriedModel model;
  model.scene[static_cast<int>(CarriedTerm::motion_before)] = -0.3;
  model.scene[static_cast<int>(CarriedTerm::target)] = 0.5;
  const auto fitted = make_carried_stepper(world.scene, model, "carried_fitted"),
             standard = make_carried_stepper(world.scene);
  CHECK(fitted->traits().past_frames == 2);
  CHECK(standard->traits().past_frames == 1);
  State a = world.state, b = world.state;
  for (int f = 0; f < 3; ++f) {
    world.drive.skinned_targets = moved(world, {0.01 * f * f, 0, 0});
    State next_a, next_b;
    testing::frame(world.scene, *fitted, a, world.drive, dt, next_a);
    testing::frame(world.scene, *standard, b, world.drive, dt, next_b);
    CHECK((next_a.x == next_b.x) == (f < 2));
    a = next_a, b = next_b;
    CHECK(a.memory.size() == (f == 0 ? 2u : 4u));
    CHECK(b.memory.size() == 2);
  }
}

TEST_CASE("carried: cloth that nothing wears falls freely, and pins go where the drive has them", "[carried]") {
  World world = make_world(testing::sheet(4, 0.2, 1));
  world.scene.pins = {0};
  world.drive.acceleration = {0, -9.81, 0};
  world.drive.pins = moved(world, {0.001, 0, 0}).topRows(1);
  const auto stepper = make_carried_stepper(world.scene);
  State to;
  REQUIRE(testing::frame(world.scene, *stepper, world.state, world.drive, dt, to).status == StepStatus::accepted);
  CHECK(to.x.row(0) == world.drive.pins.row(0));
  CHECK(to.x(5, 1) == Approx(world.state.x(5, 1) - 9.81 * dt * dt));
  CHECK(to.v(5, 1) == Approx(-9.81 * dt));
}

TEST_CASE("carried: the response to contact keeps cloth that is carried into cloth apart from it", "[carried]") {
  World world = make_world(testing::join(testing::sheet(6, 0.2, 0), testing::sheet(6, 0.2, 0.01)));
  world.scene.contact.self = true;
  Points target = world.state.x;
  const auto stepper = make_carried_stepper(world.scene);
  State first, to;
  world.drive.skinned_targets = target;
  testing::frame(world.scene, *stepper, world.state, world.drive, dt, first);
  world.drive.skinned_targets.bottomRows(36).col(1).array() -= 0.02;  // through the lower sheet
  const StepReport report = testing::frame(world.scene, *stepper, first, world.drive, dt, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.collision.impulses + report.collision.zones > 0);
  CHECK(report.collision.pairs_after == 0);
  CHECK(report.collision.passed_through == 0);
  CHECK(to.clean);
}

// The body jumps into motion, and the cloth's velocity does not know it yet.
TEST_CASE("carried: a solve begins at the carried guess where the potential is lower there", "[carried]") {
  World world = make_world(testing::sheet(5, 0.2, 1));
  const auto steps = [&](FirstGuess guess, const Points& target) {
    ConventionalOptions options;
    options.substeps = 1;
    options.guess = guess;
    options.implicit_euler.max_newton = 1;
    options.implicit_euler.linear_tolerance = 0.9;  // so rough that the end tells the start
    const auto stepper = make_conventional_stepper(world.scene, options);
    State first, second;
    world.drive.skinned_targets = world.state.x;
    testing::frame(world.scene, *stepper, world.state, world.drive, dt, first);
    CHECK((guess == FirstGuess::carried) == (find_rows(first.memory, "carried.target", first.x.rows()) != nullptr));
    world.drive.skinned_targets = target;
    REQUIRE(testing::frame(world.scene, *stepper, first, world.drive, dt, second).status == StepStatus::accepted);
    return second.x;
  };
  // Far from where inertia takes the cloth the potential is higher: the guess is not taken.
  CHECK(steps(FirstGuess::carried, moved(world, {0.3, 0, 0})) == steps(FirstGuess::inertia, world.state.x));
  // A sheet that is held at one edge, which moves on: the rest is nearer to its rest shape at the carried guess.
  for (int v = 0; v < 5; ++v) world.scene.pins.push_back(v);
  world.drive.pins = moved(world, {0.05, 0, 0}).topRows(5);
  CHECK(steps(FirstGuess::carried, moved(world, {0.05, 0, 0})) != steps(FirstGuess::inertia, world.state.x));
}

}  // namespace selvedge::test_carried_stepper
