#include <catch2/catch.hpp>

#include "collision/contour/segments.hpp"
#include "physics/energies/measures.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_icm_stepper {

using testing::add_obstacle;
using testing::make_world;
using testing::Run;
using testing::World;

namespace {

std::unique_ptr<Stepper> icm(const Scene& scene) { return make_icm_stepper(scene, {}); }

// A level sheet with an upright one through it.
World crossing_world() {
  testing::Sheet upright = testing::tilted(testing::sheet(9, 0.2, 0), 1.5);
  upright.x.col(0).array() += 0.013;
  upright.x.col(1).array() += 0.06;
  World w = make_world(testing::join(testing::sheet(10, 0.4, 0), upright));
  w.drive.acceleration.setZero();
  return w;
}

double contour_length(const World& w, const State& state) {
  const std::vector<SheetView> sheets{{&w.scene.surface, &state.x}};
  return contour_energy(sheets, find_segments(sheets), ContourMeasure::length);
}

// A sphere of n x 2n quads.
testing::Sheet ball(int n, double radius) {
  testing::Sheet s{Points(2 * n * (n - 1) + 2, 3), Triangles(4 * n * (n - 1), 3)};
  const int top = static_cast<int>(s.x.rows()) - 2, bottom = top + 1;
  const auto at = [&](int i, int j) { return (i - 1) * 2 * n + j % (2 * n); };
  int t = 0;
  for (int j = 0; j < 2 * n; ++j) {
    for (int i = 1; i < n; ++i) {
      const double polar = M_PI * i / n, round = M_PI * j / n;
      s.x.row(at(i, j)) << radius * std::sin(polar) * std::cos(round), radius * std::cos(polar),
          -radius * std::sin(polar) * std::sin(round);
      if (i + 1 == n) continue;
      s.triangles.row(t++) << at(i, j), at(i + 1, j), at(i, j + 1);
      s.triangles.row(t++) << at(i, j + 1), at(i + 1, j), at(i + 1, j + 1);
    }
    s.triangles.row(t++) << top, at(1, j), at(1, j + 1);
    s.triangles.row(t++) << bottom, at(n - 1, j + 1), at(n - 1, j);
  }
  s.x.row(top) << 0, radius, 0;
  s.x.row(bottom) << 0, -radius, 0;
  return s;
}

World draping_world(int n) {
  World w = make_world(testing::sheet(n, 0.4, 0.15));
  add_obstacle(w, ball(8, 0.1));
  return w;
}

}  // namespace

TEST_CASE("icm stepper: without contact its step is implicit Euler's", "[icm_stepper]") {
  World w = make_world(testing::sheet(6, 0.3, 0));
  w.scene.pins = {0, 6};
  w.drive.pins.resize(2, 3);
  w.drive.pins << w.state.x.row(0), w.state.x.row(6);
  const bool self = GENERATE(false, true);  // with self-contact there is a contour term, whose value is zero
  w.scene.contact.self = self;
  IcmOptions options;
  options.substeps = 1;
  options.implicit_euler.velocity_tolerance = 1e-9;
  options.implicit_euler.relative_tolerance = 0;
  options.implicit_euler.linear_tolerance = 1e-9;
  options.implicit_euler.max_newton = 60;
  const double dt = 1.0 / 60;
  State to;
  const StepReport report = testing::frame(w.scene, *make_icm_stepper(w.scene, options), w.state, w.drive, dt, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.reason == Reason::none);
  CHECK_FALSE(report.doubts.any());
  ImplicitEuler solver(w.scene, options.implicit_euler);
  const StepProblem problem{dt, &w.state.x, &w.state.v, &w.drive.pins, w.drive.acceleration, Vec3::Zero(), {}};
  Points expected = w.state.x;
  REQUIRE(solver.solve(problem, expected).converged);
  CHECK((to.x - w.state.x).norm() > 1e-3);
  CHECK((to.x - expected).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("icm stepper: two sheets that start through each other part", "[icm_stepper]") {
  const World w = crossing_world();
  const double start = contour_length(w, w.state);
  REQUIRE(start > 0.1);
  const auto stepper = icm(w.scene);
  State state = w.state;
  int frames = 0;
  for (; frames < 30 && !(frames > 0 && state.clean); ++frames) {
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_before > 0);
    CHECK(report.doubts.penetrating == (report.collision.pairs_after > 0));
    CHECK((to.x - state.x).rowwise().norm().maxCoeff() < 0.1);
    state = to;
    UNSCOPED_INFO("frame " << frames << ": " << contour_length(w, state) << " m of " << start);
  }
  CHECK(state.clean);
  CHECK(contour_length(w, state) == 0);
  CHECK(principal_stretches(w.scene, state.x).maxCoeff() < 1.3);
}

TEST_CASE("icm stepper: a sheet dropped on a ball stays usable", "[icm_stepper]") {
  const World w = draping_world(12);
  const Run r = testing::run(w, 30, 1 << 30, icm);
  CHECK(r.contacts > 0);
  CHECK(r.state.x.allFinite());
  CHECK(principal_stretches(w.scene, r.state.x).maxCoeff() < 1.3);
  CHECK(r.state.x.col(1).maxCoeff() > 0.09);  // it has not fallen through
  CHECK(r.state.x.col(1).maxCoeff() < 0.13);
}

TEST_CASE("icm stepper: caches carry no state", "[icm_stepper]") {
  for (const World& w : {draping_world(10), crossing_world()}) {
    const State kept = testing::run(w, 12, 1 << 30, icm).state, renewed = testing::run(w, 12, 3, icm).state;
    CHECK(same_bits(kept.x, renewed.x));
    CHECK(same_bits(kept.v, renewed.v));
  }
}

TEST_CASE("icm stepper: one and two threads give the same bits", "[icm_stepper]") {
  for (const World& w : {draping_world(10), crossing_world()}) {
    State one, two;
    with_threads(1, [&] { one = testing::run(w, 15, 1 << 30, icm).state; });
    with_threads(2, [&] { two = testing::run(w, 15, 1 << 30, icm).state; });
    CHECK(same_bits(one.x, two.x));
    CHECK(same_bits(one.v, two.v));
  }
}

}  // namespace selvedge::test_icm_stepper
