#include "collision/geometry/parallel.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_stop {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

// A sheet that hangs in a plate by its middle, falls, and meets itself.
World tangled() {
  World w = make_world(testing::tilted(testing::sheet(8, 0.2, 0), 1.2));
  add_obstacle(w, testing::sheet(3, 0.6, 0.003));
  return w;
}

struct Polled {
  StepReport report;
  State to;
  int polls = 0, after = 0;  // after the first that said yes
};

// A step that is stopped at its k-th poll.
Polled step_until(Stepper& stepper, const World& w, const State& from, int k) {
  Polled p;
  StepExtras extras;
  extras.stop = [&] {
    ++p.polls;
    p.after += p.polls > k;
    return p.polls >= k;
  };
  p.report = testing::frame(w.scene, stepper, from, w.drive, dt, p.to, extras);
  return p;
}

}  // namespace

TEST_CASE("stop: asked once a Newton iteration and untangling pass, and the step keeps its bits", "[stop]") {
  const World w = tangled();
  State state = w.state;
  int passes = 0;
  for (int frame = 0; frame < 6; ++frame) {
    State plain;
    const StepReport unasked = testing::frame(w.scene, *testing::conventional(w.scene), state, w.drive, dt, plain);
    const Polled p = step_until(*testing::conventional(w.scene), w, state, 1 << 30);
    REQUIRE(p.report.status == StepStatus::accepted);
    CHECK(p.to.x == plain.x);
    CHECK(p.report.iterations == unasked.iterations);
    CHECK(p.polls >= p.report.iterations + p.report.untangling + p.report.collision.zones);
    passes += p.report.untangling;
    state = plain;
  }
  CHECK(passes > 0);
}

TEST_CASE("stop: wherever a step is ended it is rejected as stopped, soon, and its start is kept", "[stop]") {
  const ThreadLimit one(1);  // how often many threads ask depends on who takes which part of a loop
  const World w = tangled();
  const State& from = w.state;
  const int polls = step_until(*testing::conventional(w.scene), w, from, 1 << 30).polls;
  REQUIRE(polls > 20);
  const std::unique_ptr<Stepper> stepper = testing::conventional(w.scene);
  int stopped = 0;
  for (int k = 1; k <= polls; k += std::max(1, polls / 12)) {
    const Polled p = step_until(*stepper, w, from, k);
    INFO("poll " << k << " of " << polls);
    if (p.polls < k) continue;  // what the stepper has kept from the last step spared it some
    ++stopped;
    CHECK(p.report.status == StepStatus::rejected);
    CHECK(p.report.reason == Reason::stopped);
    CHECK(p.after <= 8);
  }
  CHECK(stopped >= 10);
  // What was begun leaves no trace: the next step has the bits of a new stepper's.
  CHECK(step_until(*stepper, w, from, 1 << 30).to.x ==
        step_until(*testing::conventional(w.scene), w, from, 1 << 30).to.x);
  const Polled icm = step_until(*make_icm_stepper(w.scene, {}), w, from, 2);
  CHECK(icm.report.reason == Reason::stopped);
}

TEST_CASE("budget: a step that has used its Newton iterations up says so and stays free of contact", "[stop]") {
  World w = make_world(testing::sheet(10, 0.4, 0.06));
  add_obstacle(w, testing::sheet(2, 0.1, 0));
  ConventionalOptions options;
  options.implicit_euler.max_newton_step = 6;
  const auto short_of = make_recovering_conventional_stepper(w.scene, options);
  State state = w.state;
  bool ran_out = false;
  for (int frame = 0; frame < 20; ++frame) {
    State to;
    const StepReport report = testing::frame(w.scene, *short_of, state, w.drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.iterations <= options.implicit_euler.max_newton_step + 8 * report.substeps);
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    if (report.out_of_newton) CHECK(report.iterations >= options.implicit_euler.max_newton_step);
    ran_out = ran_out || report.out_of_newton;
    state = to;
  }
  CHECK(ran_out);
}

TEST_CASE("budget: untangling goes on in the next step where its passes ran out", "[stop]") {
  const World w = tangled();
  const auto stepper =
      make_recovering_stepper(w.scene, make_conventional_stepper(w.scene, {}), {.untangling_passes = 3});
  State state = w.state;
  bool ran_out = false;
  int frames = 0;
  for (; frames < 60 && !state.clean; ++frames) {
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.untangling <= 3);
    if (report.out_of_untangling) CHECK(report.collision.left_alone > 0);
    ran_out = ran_out || report.out_of_untangling;
    state = to;
  }
  CHECK(ran_out);
  CHECK(state.clean);
}

}  // namespace selvedge::test_stop
