#include "physics/solve/bdf2.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "physics/energies/measures.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_bdf2 {

using testing::make_world;
using testing::World;

namespace {

// A sheet that lies level, held at the edge x = least, and is let go. Stiffness soft enough for time steps to matter.
World swinging_world(int n, double damping = 0) {
  World w = make_world(testing::sheet(n, 0.3, 0));
  Material& material = w.scene.cloths[0].material;
  material.lame_mu = 20;
  material.lame_lambda = 10;
  material.bending = 1e-4;
  material.stiffness_damping = damping;
  const double edge = w.state.x.col(0).minCoeff();
  for (int i = 0; i < w.state.x.rows(); ++i)
    if (w.state.x(i, 0) < edge + 1e-9) w.scene.pins.push_back(i);
  w.drive.pins.resize(static_cast<Eigen::Index>(w.scene.pins.size()), 3);
  for (std::size_t k = 0; k < w.scene.pins.size(); ++k)
    w.drive.pins.row(static_cast<Eigen::Index>(k)) = w.state.x.row(w.scene.pins[k]);
  w.scene.contact.self = false;
  return w;
}

ConventionalOptions exact(Integrator integrator) {
  ConventionalOptions options;
  options.substeps = 1;
  options.integrator = integrator;
  options.implicit_euler.velocity_tolerance = 1e-11;
  options.implicit_euler.relative_tolerance = 0;
  options.implicit_euler.max_newton = 100;
  options.implicit_euler.linear_tolerance = 1e-6;
  return options;
}

ConventionalOptions with(Integrator integrator) {
  ConventionalOptions options;
  options.integrator = integrator;
  return options;
}

State run(const World& w, const ConventionalOptions& options, double time, int steps) {
  const auto stepper = make_recovering_conventional_stepper(w.scene, options);
  State state = w.state;
  for (int s = 0; s < steps; ++s) {
    State to;
    REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, time / steps, to).status == StepStatus::accepted);
    state = to;
  }
  return state;
}

State one_step(const World& w, const ConventionalOptions& options, const State& from, double dt) {
  State to;
  REQUIRE(
      testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene, options), from, w.drive, dt, to).status ==
      StepStatus::accepted);
  return to;
}

void check_same(const State& a, const State& b) {
  CHECK(same_bits(a.x, b.x));
  CHECK(same_bits(a.v, b.v));
}

// The step begins anew: positions from the mean of the velocities at both ends.
void check_begins_anew(const State& from, const State& to, double dt) {
  CHECK((to.x - from.x - dt / 2 * (from.v + to.v)).cwiseAbs().maxCoeff() < 1e-12);
}

double energy(const World& w, const State& state) {
  return energies(w.scene, state.x, state.v, w.drive.acceleration).total();
}

}  // namespace

TEST_CASE("BDF2: free fall from a true history is exact", "[bdf2]") {
  World w = make_world(testing::sheet(3, 0.3, 0));
  w.scene.contact.self = false;
  const double h = 1.0 / 60;
  const Vec3 g = w.drive.acceleration, v0(1, 2, 3);
  const auto at = [&](double t, State& state) {
    state.x = w.state.x;
    state.x.rowwise() += (t * v0 + 0.5 * t * t * g).transpose();
    state.v = Points::Zero(state.x.rows(), 3);
    state.v.rowwise() += (v0 + t * g).transpose();
  };
  State state, before, end;
  at(-h, before);
  at(0, state);
  at(10 * h, end);
  state.memory = blocks_of({h, before.x, before.v, {}});
  for (int s = 0; s < 10; ++s) state = one_step(w, exact(Integrator::bdf2), state, h);
  CHECK((state.x - end.x).cwiseAbs().maxCoeff() < 1e-13);
  CHECK((state.v - end.v).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("BDF2: what rests gives its own positions", "[bdf2]") {
  const World w = make_world(testing::sheet(4, 0.3, 0.1));
  const StepStart start = bdf2_start({0.01, w.state.x, w.state.v, {}}, w.state.x, w.state.v);
  CHECK(start.h == Approx(0.02 / 3));
  CHECK(same_bits(start.x, w.state.x));
  CHECK(same_bits(start.v, w.state.v));
}

TEST_CASE("BDF2: of second order on a swinging sheet where implicit Euler is of first", "[bdf2]") {
  const World w = swinging_world(4);
  const double time = 0.2;
  const Points truth = run(w, exact(Integrator::bdf2), time, 1600).x;
  const auto ratio = [&](Integrator integrator, int steps) {
    const double coarse = (run(w, exact(integrator), time, steps).x - truth).norm();
    const double fine = (run(w, exact(integrator), time, 2 * steps).x - truth).norm();
    return coarse / fine;
  };
  const double first = ratio(Integrator::implicit_euler, 80), second = ratio(Integrator::bdf2, 80);
  INFO("implicit Euler " << first << ", BDF2 " << second);
  CHECK(first == Approx(2).epsilon(0.15));
  CHECK(second > 3.4);
  CHECK(second < 4.6);
}

TEST_CASE("BDF2: a swinging sheet keeps more of its energy, and damping takes as much of it", "[bdf2]") {
  const double time = 0.5, fine = 5e-4;
  const auto lost = [&](const World& w, Integrator integrator, double dt) {
    return energy(w, w.state) - energy(w, run(w, exact(integrator), time, static_cast<int>(std::lround(time / dt))));
  };
  const World w = swinging_world(5);
  const double euler = lost(w, Integrator::implicit_euler, 1.0 / 60), bdf2 = lost(w, Integrator::bdf2, 1.0 / 60);
  INFO("lost [J]: implicit Euler " << euler << ", BDF2 " << bdf2);
  CHECK(bdf2 > 0);
  CHECK(bdf2 < 0.5 * euler);

  // With Rayleigh damping that is most of the loss both take the same at small steps.
  const World damped = swinging_world(5, 0.02);
  const double both = lost(damped, Integrator::implicit_euler, fine);
  CHECK(lost(damped, Integrator::bdf2, fine) == Approx(both).epsilon(0.03));
}

TEST_CASE("BDF2: a copy of the state goes on with the same bits in another stepper", "[bdf2]") {
  const World w = swinging_world(5);
  const ConventionalOptions options = with(Integrator::bdf2);
  const double dt = 1.0 / 30;
  const State middle = run(w, options, 5 * dt, 5);
  REQUIRE(step_history(middle).h == Approx(dt / 2));
  World later = w;
  later.state = middle;
  check_same(run(later, options, 5 * dt, 5), run(w, options, 10 * dt, 10));
  World forgetful = later;  // the history matters
  forgetful.state.memory.clear();
  CHECK(run(forgetful, options, 5 * dt, 5).x != run(later, options, 5 * dt, 5).x);
}

TEST_CASE("BDF2: one and two threads give the same bits", "[bdf2][threads]") {
  const World w = swinging_world(40);
  State one, two;
  with_threads(1, [&] { one = run(w, with(Integrator::bdf2), 0.3, 9); });
  with_threads(2, [&] { two = run(w, with(Integrator::bdf2), 0.3, 9); });
  check_same(one, two);
  CHECK(same_bits(step_history(one).v, step_history(two).v));
}

TEST_CASE("BDF2: the first substep and one of another length begin anew; pins that jump make it implicit Euler's",
          "[bdf2]") {
  World w = swinging_world(5);
  const ConventionalOptions euler = exact(Integrator::implicit_euler), bdf2 = exact(Integrator::bdf2);
  const double dt = 1.0 / 60;
  const State first = one_step(w, bdf2, w.state, dt);
  check_begins_anew(w.state, first, dt);
  CHECK(step_history(first).h == dt);
  CHECK(step_history(one_step(w, euler, w.state, dt)).h == 0);
  const State second = one_step(w, bdf2, first, dt);
  CHECK(second.x != one_step(w, euler, first, dt).x);
  check_begins_anew(second, one_step(w, bdf2, second, dt / 2), dt / 2);
  w.drive.pins.col(1).array() += 0.4 * mean_edge_length(w.scene);  // less than a jump
  CHECK(one_step(w, bdf2, second, dt).x != one_step(w, euler, second, dt).x);
  w.drive.pins.col(1).array() += 0.8 * mean_edge_length(w.scene);
  check_same(one_step(w, bdf2, second, dt), one_step(w, euler, second, dt));
}

TEST_CASE("BDF2: after an obstacle that jumps far the substep begins anew", "[bdf2]") {
  World w = make_world(testing::sheet(5, 0.3, 0.5));
  testing::add_obstacle(w, testing::sheet(3, 0.05, 0));
  const ConventionalOptions bdf2 = exact(Integrator::bdf2);
  const double dt = 1.0 / 60;
  State from = one_step(w, bdf2, w.state, dt);
  REQUIRE(step_history(from).h == dt);
  from.v.col(1).array() += 1;  // which the history does not have
  State forgetful = from;
  forgetful.memory.clear();
  w.drive.obstacles[0].col(0).array() += 0.01;
  CHECK(one_step(w, bdf2, from, dt).x != one_step(w, bdf2, forgetful, dt).x);
  w.drive.obstacles[0].col(0).array() += 10;
  check_same(one_step(w, bdf2, from, dt), one_step(w, bdf2, forgetful, dt));
}

TEST_CASE("BDF2: what touches is marked, and the rest goes on; cloth stays clean", "[bdf2]") {
  World w = make_world(testing::sheet(12, 0.3, 0.1));
  testing::add_obstacle(w, testing::sheet(3, 0.2, 0));
  const double dt = 1.0 / 30;
  const ConventionalOptions bdf2 = with(Integrator::bdf2);
  State state = w.state;
  int free = 0, touching = 0, partly = 0;
  for (int f = 0; f < 30; ++f) {
    State to;
    const StepReport report =
        testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene, bdf2), state, w.drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    const StepHistory history = step_history(to);
    CHECK(history.h > 0);
    free += history.free();
    touching += report.collision.contacts > 0;
    if (report.collision.contacts > 0) CHECK_FALSE(history.free());
    partly += !history.free() && std::ranges::count(history.contact, VertexContact::none) > 0;
    state = to;
  }
  CHECK(free > 2);
  CHECK(touching > 10);
  CHECK(partly > 10);
}

TEST_CASE("BDF2: an impact that is met only on the way does not throw the cloth back", "[bdf2]") {
  World w = make_world(testing::sheet(6, 0.2, 0.05));
  testing::add_obstacle(w, testing::sheet(3, 0.5, 0));
  w.state.v.col(1).setConstant(-6);
  State from = w.state;
  const double dt = 1.0 / 60;
  from.memory = blocks_of({dt, w.state.x - dt * w.state.v, w.state.v, {}});
  ConventionalOptions bdf2 = with(Integrator::bdf2);
  bdf2.substeps = 1;
  const State to = one_step(w, bdf2, from, dt);
  CHECK(to.x.col(1).minCoeff() > 0);
  CHECK(to.v.col(1).maxCoeff() < 0);
  CHECK_FALSE(step_history(to).free());
}

}  // namespace selvedge::test_bdf2
