#include "physics/steppers/vertex_history.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "physics/energies/measures.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_vertex_history {

using testing::add_obstacle;
using testing::make_world;
using testing::sheet;
using testing::World;

namespace {

ConventionalOptions with(Integrator integrator) {
  ConventionalOptions options;
  options.integrator = integrator;
  return options;
}

// One substep a step, solved to the end.
ConventionalOptions exact(Integrator integrator) {
  ConventionalOptions options = with(integrator);
  options.substeps = 1;
  options.implicit_euler.velocity_tolerance = 1e-10;
  options.implicit_euler.relative_tolerance = 0;
  options.implicit_euler.max_newton = 100;
  options.implicit_euler.linear_tolerance = 1e-6;
  return options;
}

using See = std::function<void(const State&, const StepReport&)>;

State run(const World& w, const ConventionalOptions& options, double dt, int steps, const See& see = {}) {
  const auto stepper = make_recovering_conventional_stepper(w.scene, options);
  State state = w.state;
  for (int s = 0; s < steps; ++s) {
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    REQUIRE(report.collision.pairs_after == 0);
    REQUIRE(report.collision.passed_through == 0);
    state = std::move(to);
    if (see) see(state, report);
  }
  return state;
}

void add_sheet(World& w, const testing::Sheet& more) {
  const int before = w.scene.surface.vertex_count;
  add_cloth(w.scene, more.x, more.triangles, {}, "more");
  Points x(before + more.x.rows(), 3);
  x << w.state.x, more.x;
  const auto obstacles = w.state.obstacles;
  w.state = first_state(w.scene, x);
  w.state.obstacles = obstacles;
}

double energy(const World& w, const State& state) {
  return energies(w.scene, state.x, state.v, w.drive.acceleration).total();
}

int touching(const State& state) {
  const StepHistory history = step_history(state);
  return static_cast<int>(
      std::ranges::count_if(history.contact, [](VertexContact c) { return c != VertexContact::none; }));
}

constexpr int side = 5;

// A soft sheet that is held along an edge and let go, and another one that lies on a plate beside it.
World swinging_beside_lying() {
  World w = make_world(sheet(side, 0.3, 0.5));
  Material& material = w.scene.cloths[0].material;
  material.lame_mu = 20;
  material.lame_lambda = 10;
  material.bending = 1e-4;
  const double edge = w.state.x.col(0).minCoeff();
  for (int i = 0; i < w.state.x.rows(); ++i)
    if (w.state.x(i, 0) < edge + 1e-9) w.scene.pins.push_back(i);
  testing::Sheet lying = sheet(2, 0.1, 0.0019), plate = sheet(1, 0.4, 0);
  lying.x.col(0).array() += 2;
  plate.x.col(0).array() += 2;
  add_sheet(w, lying);
  w.drive.pins = w.state.x(w.scene.pins, Eigen::all);
  add_obstacle(w, plate);
  return w;
}

Points swinging_part(const State& state) { return state.x.topRows((side + 1) * (side + 1)); }

}  // namespace

TEST_CASE("history by vertex: cloth that swings is of second order while other cloth touches", "[vertex_history]") {
  const World w = swinging_beside_lying();
  const double time = 0.2;
  const auto end = [&](Integrator integrator, int steps) {
    int touched = 0;
    const State state = run(w, exact(integrator), time / steps, steps, [&](const State& at, const StepReport& r) {
      touched += touching(at) + r.collision.contacts;
    });
    CHECK(touched > steps);
    return swinging_part(state);
  };
  const Points truth = end(Integrator::bdf2, 1280);
  const auto ratio = [&](Integrator integrator) {
    return (end(integrator, 80) - truth).norm() / (end(integrator, 160) - truth).norm();
  };
  const double first = ratio(Integrator::implicit_euler), second = ratio(Integrator::bdf2);
  INFO("implicit Euler " << first << ", BDF2 " << second);
  CHECK(first < 2.4);
  CHECK(second > 3.2);
}

TEST_CASE("history by vertex: free fall is exact from rest, and from the first step", "[vertex_history]") {
  World w = make_world(sheet(3, 0.3, 10));
  add_obstacle(w, sheet(1, 1, 0));
  const double dt = 1.0 / 60;
  const Vec3 v0(0.3, 1, -0.2);
  w.state.v.rowwise() = v0.transpose();
  int steps = 0;
  run(w, with(Integrator::bdf2), dt, 20, [&](const State& at, const StepReport&) {
    const double t = ++steps * dt;
    const Vec3 moved = t * v0 + 0.5 * t * t * w.drive.acceleration;
    CHECK(((at.x - w.state.x).rowwise() - moved.transpose()).cwiseAbs().maxCoeff() < 1e-11);
  });
}

TEST_CASE("history by vertex: sheets that meet in free flight keep their momentum", "[vertex_history]") {
  World w = make_world(testing::tilted(sheet(6, 0.2, 0), 0.3));
  const testing::Sheet other = sheet(5, 0.17, 0.15);
  add_sheet(w, other);
  w.state.v.bottomRows(other.x.rows()).col(1).setConstant(-1);
  const Eigen::VectorXd masses = lumped_masses(w.scene);
  const double mass = masses.sum(), dt = 1.0 / 30;
  const Vec3 start = w.state.v.transpose() * masses;
  int steps = 0, together = 0;
  run(w, exact(Integrator::bdf2), dt, 20, [&](const State& at, const StepReport& report) {
    const Vec3 momentum = at.v.transpose() * masses;
    CHECK((momentum - start - ++steps * dt * mass * w.drive.acceleration).norm() < 1e-9 * mass);
    together += report.collision.contacts > 0;
  });
  CHECK(together > 2);
  CHECK(together < 18);  // part of the flight is free
}

TEST_CASE("history by vertex: what lies at rest stays there", "[vertex_history]") {
  World w = make_world(sheet(8, 0.3, 0.0019));
  add_obstacle(w, sheet(2, 0.6, 0));
  const State settled = run(w, with(Integrator::bdf2), 1.0 / 30, 30);
  CHECK(touching(settled) == settled.x.rows());
  World later = w;
  later.state = settled;
  const State end = run(later, with(Integrator::bdf2), 1.0 / 30, 60);
  CHECK((end.x - settled.x).rowwise().norm().maxCoeff() < 2e-5);
  CHECK(end.v.rowwise().norm().maxCoeff() < 1e-4);
  const State euler = run(w, with(Integrator::implicit_euler), 1.0 / 30, 30);
  CHECK((euler.x - settled.x).rowwise().norm().maxCoeff() < 2e-4);
}

TEST_CASE("history by vertex: a dropped sheet rebounds no higher than with implicit Euler and gains no energy",
          "[vertex_history]") {
  const double tilt = GENERATE(0.0, 0.4);
  World w = make_world(testing::tilted(sheet(8, 0.3, 0), tilt));
  w.state.x.col(1).array() += 0.12;
  w.state.v.col(1).setConstant(-1);
  add_obstacle(w, sheet(2, 1, 0));
  // The largest height of the middle after it was lowest.
  const auto rebound = [&](Integrator integrator) {
    double lowest = 1, highest = 0, least = energy(w, w.state);
    const double tolerated = 0.01 * least;
    run(w, with(integrator), 1.0 / 30, 40, [&](const State& at, const StepReport& report) {
      const double height = at.x.col(1).mean(), now = energy(w, at);
      CHECK(now <= least + tolerated);
      CHECK_FALSE(report.doubts.energy_gain);
      least = std::min(least, now);
      if (height < lowest) lowest = highest = height;
      highest = std::max(highest, height);
    });
    return highest - lowest;
  };
  const double euler = rebound(Integrator::implicit_euler), bdf2 = rebound(Integrator::bdf2);
  INFO("rebound [m]: implicit Euler " << euler << ", BDF2 " << bdf2);
  CHECK(bdf2 <= euler + 1e-3);
}

TEST_CASE("history by vertex: the rule of a vertex", "[vertex_history]") {
  using C = VertexContact;
  using R = VertexRule;
  using Rules = std::vector<R>;
  World w = make_world(sheet(1, 0.2, 0.1));
  const double h = 0.01;
  ContactTerm with_obstacle;
  with_obstacle.nodes[0] = 0;
  with_obstacle.weights[0] = 1;
  const Contacts nothing, ground{{NodePair{}}, {with_obstacle}};
  const auto rules = [&](double past_h, std::vector<C> past, const Contacts& contacts) {
    const StepHistory history{past_h, w.state.x, w.state.v, std::move(past)};
    std::vector<C> contact(4, C::none);
    mark_near(history, contacts, contact);
    return vertex_rules(PinnedParts(w.scene), history, h, contacts, contact);
  };
  CHECK(rules(h, {}, nothing) == Rules(4, R::bdf2));
  CHECK(rules(h / 2, {}, nothing) == Rules(4, R::start));
  CHECK(rules(0, {}, nothing) == Rules(4, R::start));
  CHECK(rules(h, {}, ground) == Rules{R::euler, R::bdf2, R::bdf2, R::bdf2});
  const std::vector<C> past{C::begun, C::begun, C::near, C::none};
  CHECK(rules(h, past, ground) == Rules{R::euler, R::start, R::bdf2, R::bdf2});
  CHECK(rules(h, {C::near, C::near, C::begun, C::none}, ground) == Rules{R::bdf2, R::bdf2, R::start, R::bdf2});
  CHECK(rules(h, past, nothing) == Rules(4, R::start));  // nothing holds the part
  w.scene.pins = {3};
  CHECK(rules(h, past, nothing) == Rules{R::start, R::start, R::bdf2, R::bdf2});
}

}  // namespace selvedge::test_vertex_history
