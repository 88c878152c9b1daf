#include <catch2/catch.hpp>

#include <cmath>
#include "physics/energies/measures.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_conventional_stepper {

using testing::add_obstacle;
using testing::make_world;
using testing::Run;
using testing::run;
using testing::World;

namespace {

// A small sheet that falls on a peaked block and folds over it.
World folding_world(int n) {
  World w = make_world(testing::sheet(n, 0.4, 0.08));
  testing::Sheet peak;
  peak.x.resize(5, 3);
  peak.x << -0.1, 0, -0.1, 0.1, 0, -0.1, 0.1, 0, 0.1, -0.1, 0, 0.1, 0.01, 0.06, 0.02;
  peak.triangles.resize(6, 3);
  peak.triangles << 0, 1, 2, 0, 2, 3, 0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0;
  add_obstacle(w, peak);
  add_obstacle(w, testing::sheet(2, 3, -0.05));
  return w;
}

void same_bits(const State& a, const State& b) {
  CHECK(a.x == b.x);
  CHECK(a.v == b.v);
}

}  // namespace

TEST_CASE("conventional stepper: free fall is implicit Euler's, to rounding", "[conventional_stepper]") {
  World w = make_world(testing::sheet(3, 0.3, 0));
  w.scene.contact.self = false;
  w.state.v.rowwise() = Eigen::RowVector3d(1, 2, 3);
  ConventionalOptions options;
  options.substeps = 4;
  auto stepper = make_recovering_conventional_stepper(w.scene, options);
  State state = w.state;
  const int frames = 10;
  for (int f = 0; f < frames; ++f) {
    State to;
    REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    state = to;
  }
  const int n = 4 * frames;
  const double h = 1.0 / 120;
  Points expected = w.state.x + n * h * w.state.v;
  expected.col(1).array() -= 9.81 * h * h * n * (n + 1) / 2;
  CHECK((state.x - expected).cwiseAbs().maxCoeff() < 1e-10);
  CHECK(state.frame == frames);
  CHECK(state.time == Approx(frames / 30.0));
}

TEST_CASE("conventional stepper: a clean start has no pairs, and those of another are not counted",
          "[conventional_stepper]") {
  World w = make_world(testing::sheet(3, 0.3, 0));
  auto stepper = make_conventional_stepper(w.scene, {});
  State to;
  for (const bool clean : {true, false}) {
    w.state.clean = clean;
    CHECK(stepper->step(w.state, w.drive, 1.0 / 30, to).collision.pairs_before == (clean ? 0 : -1));
  }
}

TEST_CASE("conventional stepper: a sheet folds over a peak and stays clean", "[conventional_stepper]") {
  const World w = folding_world(14);
  const Run r = run(w, 45);
  CHECK(r.contacts > 0);
  CHECK(r.pairs == 0);
  CHECK(r.passed_through == 0);
  CHECK(r.lag == 0);
  CHECK(r.state.x.col(1).minCoeff() > -0.05);
  CHECK(principal_stretches(w.scene, r.state.x).maxCoeff() < 1.2);
}

// Two plates that close on a sheet to nothing, stay, and open again.
TEST_CASE("conventional stepper: plates that close on cloth lag, leave it clean, and are where they belong again soon",
          "[conventional_stepper]") {
  World w = make_world(testing::sheet(8, 0.2, 0));
  for (const double side : {-1.0, 1.0}) add_obstacle(w, testing::sheet(2, 0.5, side * 0.02));
  State state = w.state;
  ConventionalOptions options;
  options.implicit_euler.max_newton = 3;  // enough for what is kept, not for an attempt without room
  auto stepper = make_recovering_conventional_stepper(w.scene, options);
  double worst_lag = 0;
  for (int f = 1; f <= 30; ++f) {
    const double half = f < 10 ? 0.02 * (1 - f / 10.0) : f < 15 ? 0 : std::min(0.02, 0.02 * (f - 15) / 5.0);
    for (int k = 0; k < 2; ++k) w.drive.obstacles[k].col(1).setConstant((k == 0 ? -1 : 1) * half);
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    worst_lag = std::max(worst_lag, report.collision.obstacle_lag);
    CHECK(report.collision.held_vertices == 0);
    CHECK(report.reason == Reason::none);
    CHECK_FALSE(report.doubts.any());
    if (f > 11 && f <= 15) CHECK(report.collision.impulses < 20);  // plates wait where there is room
    if (f < 8 || f > 25) CHECK(report.collision.obstacle_lag == 0);
    if (f > 25) CHECK(report.collision.pairs_wanted == 0);
    state = to;
  }
  CHECK(worst_lag > 0);
  CHECK(worst_lag < 0.01);
}

TEST_CASE("conventional stepper: the path that is audited ends where cloth and obstacles are",
          "[conventional_stepper]") {
  World w = make_world(testing::sheet(8, 0.2, 0));
  for (const double side : {-1.0, 1.0}) add_obstacle(w, testing::sheet(2, 0.5, side * 0.02));
  const auto stepper = testing::conventional(w.scene);
  State state = w.state, to;
  double lag = 0;
  for (int f = 1; f <= 25; ++f) {
    const double half = f < 10 ? 0.02 * (1 - f / 10.0) : f < 15 ? 0 : std::min(0.02, 0.02 * (f - 15) / 5.0);
    for (int k = 0; k < 2; ++k) w.drive.obstacles[k].col(1).setConstant((k == 0 ? -1 : 1) * half);
    StepReport report = stepper->step(state, w.drive, 1.0 / 30, to, {});
    REQUIRE(report.status == StepStatus::accepted);
    REQUIRE_FALSE(report.path.substeps.empty());
    const Points off = report.path.substeps.back().nodes - gather_nodes(to.x, to.obstacles);
    CHECK(off.cwiseAbs().maxCoeff() < 1e-12);
    lag = std::max(lag, report.collision.obstacle_lag);
    to.clean = true;
    state = to;
  }
  CHECK(lag > 0);
}

// A sheet of which the first row is pinned and driven into what lies below it, by `depth` in so many frames and back.
struct Drawn {
  int out_of_response = 0, pairs = 0, shortened = 0, substeps = 0;
  std::int64_t swept = 0, projected = 0;  // of a frame, at most
  double lag = 0, off = 0;                // obstacles; pins in the last frame [m]
  Points lowest;                          // pins where they were lowest
};

Drawn drawn(World w, int pinned, double depth, int frames, const ConventionalOptions& options = {}) {
  for (int k = pinned - 1; k >= 0; --k) w.scene.pins.insert(w.scene.pins.begin(), k);
  w.drive = at_rest(w.scene, w.state);
  const Points start = w.drive.pins;
  const auto stepper = make_recovering_conventional_stepper(w.scene, options);
  Drawn d;
  State state = w.state, to;
  for (int f = 1; f <= 2 * frames; ++f) {
    w.drive.pins = start;
    w.drive.pins.topRows(pinned).col(1).array() -= depth * (1 - std::abs(f - frames) / double(frames));
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    d.out_of_response += report.out_of_response;
    d.substeps = std::max(d.substeps, report.substeps);
    d.pairs += report.collision.pairs_after + report.collision.passed_through;
    d.shortened += report.collision.shortened;
    d.lag = std::max(d.lag, report.collision.obstacle_lag);
    d.swept = std::max(d.swept, report.counts.swept);
    d.projected = std::max(d.projected, report.counts.projected);
    state = to;
    if (f == frames) d.lowest = state.x.topRows(pinned);
  }
  d.off = (state.x.topRows(pinned) - start.topRows(pinned)).rowwise().norm().maxCoeff();
  return d;
}

TEST_CASE("conventional stepper: pins that are driven through a wall that stands still give way to it, in few counts",
          "[conventional_stepper]") {
  World w = make_world(testing::sheet(8, 0.2, 0.04));
  add_obstacle(w, testing::sheet(2, 1, 0));
  const Drawn d = drawn(w, 9, 0.2, 6);
  CHECK(d.pairs == 0);
  CHECK(d.lag == 0);
  CHECK(d.shortened > 0);  // the report says so
  CHECK(d.out_of_response == 0);
  CHECK(d.lowest.col(1).minCoeff() > 0);
  CHECK(d.off < 1e-9);
  CHECK(d.swept < 20000);
}

TEST_CASE("conventional stepper: pins that cannot all be where they are wanted are bounded in counts, and clean",
          "[conventional_stepper]") {
  World w = make_world(testing::join(testing::sheet(5, 0.2, 0.04), testing::sheet(5, 0.3, 0)));
  for (int v = 36; v < 72; ++v) w.scene.pins.push_back(v);
  ConventionalOptions options;
  options.resolve.budget = {1000, 1000};
  options.max_substeps = 2;
  const Drawn d = drawn(w, 6, 0.3, 4, options);
  CHECK(d.out_of_response > 0);
  CHECK(d.pairs == 0);
  CHECK(d.shortened > 0);
  CHECK(d.projected < 2 * options.resolve.budget.projected);

  // What runs out of its budget is tried once more, in as many substeps as there may be.
  options.max_substeps = 12;
  const Drawn again = drawn(w, 6, 0.3, 4, options);
  CHECK(d.substeps < 12);
  CHECK(again.substeps >= 12);
  CHECK(again.pairs == 0);
  CHECK(again.projected < 4 * options.resolve.budget.projected);
}

TEST_CASE("conventional stepper: pins of one cloth that are brought to one place stay apart, and the cloth goes on",
          "[conventional_stepper]") {
  World w = make_world(testing::sheet(10, 0.4, 1));
  w.scene.pins = {0, 10};
  const auto stepper = testing::conventional(w.scene);
  const Points wide = w.state.x(w.scene.pins, Eigen::all);
  const Eigen::RowVector3d middle = wide.colwise().mean();
  State state = w.state, to;
  int held = 0;
  for (int f = 1; f <= 30; ++f) {
    w.drive.pins = wide + std::min(1.0, f / 15.0) * (middle.replicate(2, 1) - wide);
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after + report.collision.passed_through == 0);
    CHECK(report.collision.held_vertices <= 2 * report.substeps);  // the pins alone
    held += report.collision.held_vertices;
    std::swap(state, to);
  }
  CHECK(held > 0);
  CHECK((state.x.row(0) - state.x.row(10)).norm() < 1e-3);
  CHECK(state.x.col(1).minCoeff() < 1 - 0.3);  // it has fallen, and hangs
  CHECK(state.v.rowwise().norm().maxCoeff() > 0);
}

TEST_CASE("conventional stepper: pins that a body carries stay on it where a limb comes at them, others give way",
          "[conventional_stepper]") {
  World w = make_world(testing::sheet(8, 0.2, 0.05));
  add_obstacle(w, testing::block({0, 0, 0.1}, 0.03));
  for (int v = 0; v < w.state.x.rows(); ++v)
    if (w.state.x(v, 2) > 0.099) w.scene.pins.push_back(v);
  REQUIRE(w.scene.pins.size() == 9);
  const Points at = w.state.x(w.scene.pins, Eigen::all);
  w.drive.pins = at;
  for (const bool worn : {true, false}) {
    const auto stepper = testing::conventional(w.scene);
    State state = w.state, to;
    Drive drive = w.drive;
    if (worn) {
      drive.skinned_targets = w.state.x;
      drive.bodies.resize(1);
      drive.bodies[0].joints = Points::Zero(1, 3);
    }
    double off = 0;
    for (int f = 1; f <= 8; ++f) {
      drive.obstacles[0].col(1).array() += 0.01;  // its top from 2 cm below the pins to 6 cm above
      REQUIRE(testing::frame(w.scene, *stepper, state, drive, 1.0 / 30, to).status == StepStatus::accepted);
      std::swap(state, to);
      off = std::max(off, (state.x(w.scene.pins, Eigen::all) - at).rowwise().norm().maxCoeff());
    }
    INFO("worn " << worn);
    CHECK((worn ? off == 0 : off > 0.05));
  }
}

TEST_CASE("conventional stepper: caches carry no state", "[conventional_stepper]") {
  const World w = folding_world(10);
  const Run kept = run(w, 20), dropped = run(w, 20, 3);
  same_bits(kept.state, dropped.state);
  CHECK(kept.contacts == dropped.contacts);
}

// Two small sheets on a plate, which have come to rest.
World resting_world() {
  World w = make_world(testing::join(testing::sheet(5, 0.1, 2e-3), testing::sheet(6, 0.08, 5e-3)));
  add_obstacle(w, testing::sheet(4, 0.4, 0));
  w.state = run(w, 45).state;
  return w;
}

TEST_CASE("conventional stepper: caches carry no state at rest either", "[conventional_stepper]") {
  const World w = resting_world();
  same_bits(run(w, 20).state, run(w, 20, 3).state);
}

TEST_CASE("conventional stepper: cloth at rest is solved once a substep, and stays", "[conventional_stepper]") {
  const World w = resting_world();
  auto stepper = make_recovering_conventional_stepper(w.scene, {});
  State state = w.state, to;
  int iterations = 0, substeps = 0;
  for (int f = 0; f < 60; ++f) {
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    iterations += report.iterations;
    substeps += report.substeps;
    CHECK(report.collision.contacts > 20);
    CHECK(report.collision.pairs_after == 0);
    state = to;
  }
  CHECK(substeps == 120);
  CHECK(iterations < 2 * substeps);
  CHECK((state.x - w.state.x).rowwise().norm().maxCoeff() < 1e-4);
}

TEST_CASE("conventional stepper: one and two threads give the same bits in 100 frames with contact",
          "[conventional_stepper]") {
  const World w = folding_world(10);
  Run one, two;
  with_threads(1, [&] { one = run(w, 100); });
  with_threads(2, [&] { two = run(w, 100); });
  CHECK(one.contacts > 0);
  same_bits(one.state, two.state);
}

TEST_CASE("conventional stepper: friction holds a sheet on a slope below its angle and lets it slide above",
          "[conventional_stepper]") {
  const double angle = 0.3;  // tan = 0.309
  World w = make_world(testing::tilted(testing::sheet(5, 0.1, 2e-3), angle));
  add_obstacle(w, testing::tilted(testing::sheet(4, 4, 0), angle));
  w.scene.contact.self = false;
  const Vec3 down(-std::cos(angle), -std::sin(angle), 0);
  w.scene.contact.friction = 0.4;
  const Run settled = run(w, 15);  // lands, from the thickness to where its weight puts it
  w.state = settled.state;
  const Run held = run(w, 60);
  CHECK(std::abs(((held.state.x - w.state.x) * down).mean()) < 1e-4);
  w.scene.contact.friction = 0.2;
  const Run sliding = run(w, 30);
  const double expected = 0.5 * 9.81 * (std::sin(angle) - 0.2 * std::cos(angle));  // after 1 s
  CHECK(((sliding.state.x - w.state.x) * down).mean() == Approx(expected).epsilon(0.05));
}

TEST_CASE("conventional stepper: a sheet that slides or hits is stepped finer than one that flies as fast",
          "[conventional_stepper]") {
  const auto substeps = [](double height, const Vec3& velocity, double dt = 1.0 / 30) {
    World w = make_world(testing::sheet(8, 0.2, height));
    add_obstacle(w, testing::sheet(2, 4, 0));
    w.drive.acceleration.setZero();
    w.state.v.rowwise() = velocity.transpose();
    State to;
    const StepReport report =
        testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene, {}), w.state, w.drive, dt, to);
    CHECK(to.clean);
    CHECK(report.collision.passed_through == 0);
    return report.substeps;
  };
  const double edge = 0.2 * (2 + std::sqrt(2.0)) / (3 * 8);
  CHECK(substeps(0.1, {10, 0, 0}) == 2);
  CHECK(substeps(0.1, {10, 0, 0}, 1.0 / 60) == 1);  // short enough to damp little
  // Contact presses a sheet that lies within its gap until it leaves. One that leaves at the start is not pressed.
  CHECK(substeps(1.5e-3, {4, 0, 0}) == std::ceil(4.0 / 60 / edge) + 1);
  CHECK(substeps(1.5e-3, {4, 1, 0}) == 2);
  // It meets the floor in the first of two substeps, or in the second; what counts is the way after that.
  const double in_substep = 10.0 / 60, edges = 2.5 * edge;
  CHECK(substeps(0.02, {0, -10, 0}) == std::ceil((in_substep - 0.02) / edges) + 1);
  CHECK(substeps(0.2, {0, -10, 0}) == 1 + std::ceil((2 * in_substep - 0.2) / edges));
  CHECK(substeps(0.13, {0, -10, 0}) == 2);
}

}  // namespace selvedge::test_conventional_stepper
