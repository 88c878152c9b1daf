#include "physics/steppers/recovering_stepper.hpp"

#include "collision/geometry/error.hpp"
#include "physics/solve/step_problem.hpp"
#include "physics/steppers/finish_step.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_recovering_stepper {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

// Steps nothing and keeps what it is asked for.
struct Asked {
  State from;
  bool guess = false, added = false;
  int left_alone = 0;
};
class AskedStepper final : public Stepper {
 public:
  AskedStepper(Asked& asked, bool honours) : asked_(asked), traits_{.name = "asked", .honours_extras = honours} {}
  const StepperTraits& traits() const override { return traits_; }
  StepReport step(const State& from, const Drive& drive, double h, State& to, const StepExtras& extras) override {
    asked_ = {from, extras.guess != nullptr, bool(extras.added),
              extras.left_alone ? extras.left_alone->tangled_vertices() : 0};
    StepReport report;
    finish_step(from, drive, h, {from.x, from.v, drive.obstacles}, to, report);
    return report;
  }

 private:
  Asked& asked_;
  StepperTraits traits_;
};

// A sheet that hangs in a plate by its middle.
World tangled() {
  World w = make_world(testing::tilted(testing::sheet(6, 0.2, 0), 1.2));
  add_obstacle(w, testing::sheet(3, 0.6, 0.003));
  return w;
}

}  // namespace

TEST_CASE("recovering stepper: refuses an inner stepper that cannot be told what to leave alone", "[recovering]") {
  const World w = tangled();
  CHECK_THROWS_AS(make_recovering_stepper(w.scene, make_icm_stepper(w.scene, {})), Error);
}

TEST_CASE("recovering stepper: a clean start is handed on as it is", "[recovering]") {
  World w = make_world(testing::sheet(4, 0.2, 0.05));
  add_obstacle(w, testing::sheet(3, 0.6, 0));
  w.state.clean = true;
  w.state.memory = {{"asked.rates", MemoryRows::Ones(w.state.x.rows(), 3), RowsOf::vertices}};
  Asked asked;
  const auto stepper = make_recovering_stepper(w.scene, std::make_unique<AskedStepper>(asked, true));
  State to;
  const Points guess = w.state.x;
  StepExtras extras;
  extras.guess = &guess;
  CHECK(testing::frame(w.scene, *stepper, w.state, w.drive, dt, to, extras).status == StepStatus::accepted);
  CHECK((asked.guess && !asked.added && asked.left_alone == 0));
  CHECK(asked.from.x == w.state.x);
  CHECK(asked.from.memory.size() == 1);
  CHECK(to.memory.empty());
}

TEST_CASE("recovering stepper: of a tangled start the cloth is moved, the motion forgotten, the rest left alone",
          "[recovering]") {
  World w = tangled();
  w.state.memory = {{"asked.rates", MemoryRows::Ones(w.state.x.rows(), 3), RowsOf::vertices}};
  Asked asked;
  const auto stepper = make_recovering_stepper(w.scene, std::make_unique<AskedStepper>(asked, true));
  const State before = w.state;
  State to;
  testing::frame(w.scene, *stepper, w.state, w.drive, dt, to);
  CHECK(asked.from.x != before.x);
  CHECK((asked.from.x - before.x).rowwise().norm().maxCoeff() <= dt * 1.001);  // at most 1 m/s
  CHECK(asked.from.memory.empty());
  CHECK(asked.left_alone > 0);
  CHECK(asked.added);
  CHECK(w.state.x == before.x);
  Exemption more;
  more.self.assign(static_cast<std::size_t>(w.state.x.rows()), 1);
  StepExtras extras;
  extras.left_alone = &more;
  testing::frame(w.scene, *stepper, w.state, w.drive, dt, to, extras);
  CHECK(asked.left_alone == w.state.x.rows());
}

TEST_CASE("recovering stepper: remembers where dressed cloth was clean last, until it is clean again", "[recovering]") {
  World w = make_world(testing::sheet(4, 0.2, 0.05));
  add_obstacle(w, testing::sheet(3, 0.6, 0));
  w.state.clean = true;
  w.drive.skinned_targets = w.state.x;
  Asked asked;
  const auto stepper = make_recovering_stepper(w.scene, std::make_unique<AskedStepper>(asked, true));
  State dirty;
  Drive through = w.drive;
  through.obstacles[0] = testing::tilted(testing::sheet(3, 0.6, 0.05), 0.1).x;
  testing::frame(w.scene, *stepper, w.state, through, dt, dirty);
  REQUIRE_FALSE(dirty.clean);
  CHECK(last_clean(dirty).x == w.state.x);
  CHECK(last_clean(dirty).obstacles == w.state.obstacles);
  through.skinned_targets.resize(0, 3);
  testing::frame(w.scene, *stepper, w.state, through, dt, dirty);
  CHECK(last_clean(dirty).x.rows() == 0);
}

TEST_CASE("conventional stepper: a good guess ends where its own does, in fewer iterations", "[recovering]") {
  World w = make_world(testing::sheet(8, 0.4, 0.3));
  w.scene.pins = {0, 8};
  w.drive.pins = w.state.x({0, 8}, Eigen::all);
  ConventionalOptions options;
  options.substeps = 1;
  options.implicit_euler.velocity_tolerance = 1e-7;
  options.implicit_euler.relative_tolerance = 0;
  options.implicit_euler.max_newton = 50;
  const auto stepper = make_conventional_stepper(w.scene, options);
  State from = w.state, own, guessed;
  for (int f = 0; f < 5; ++f) {
    testing::frame(w.scene, *stepper, from, w.drive, dt, own);
    from = own;
  }
  const StepReport plain = testing::frame(w.scene, *stepper, from, w.drive, dt, own);
  StepExtras extras;
  extras.guess = &own.x;
  const StepReport warm = testing::frame(w.scene, *stepper, from, w.drive, dt, guessed, extras);
  CHECK(warm.iterations < plain.iterations);
  CHECK((guessed.x - own.x).rowwise().norm().maxCoeff() < 1e-5);
  const Points far = (own.x.array() + 1e3).matrix();  // its own guess is better
  extras.guess = &far;
  testing::frame(w.scene, *stepper, from, w.drive, dt, guessed, extras);
  CHECK((guessed.x - own.x).rowwise().norm().maxCoeff() < 1e-5);
}

TEST_CASE("conventional stepper: what it is told to leave alone goes through, an added term pulls", "[recovering]") {
  World w = make_world(testing::sheet(4, 0.2, 0.004));
  add_obstacle(w, testing::sheet(3, 0.6, 0));
  w.state.clean = true;
  w.state.v.col(1).setConstant(-1);
  const auto stepper = make_conventional_stepper(w.scene, {});
  State held, through, pulled;
  testing::frame(w.scene, *stepper, w.state, w.drive, dt, held);
  CHECK(held.x.col(1).minCoeff() > 0);
  Exemption all;
  all.body.assign(static_cast<std::size_t>(w.state.x.rows()), 1);
  StepExtras extras;
  extras.left_alone = &all;
  const StepReport report = testing::frame(w.scene, *stepper, w.state, w.drive, dt, through, extras);
  CHECK(report.collision.left_alone == w.state.x.rows());
  CHECK(through.x.col(1).maxCoeff() < 0);
  State again;
  testing::frame(w.scene, *stepper, w.state, w.drive, dt, again);  // and it is forgotten
  CHECK(again.x == held.x);

  extras = {};
  extras.added = [](const Points&, double) {
    AddedTerm force;  // 1 N along x on vertex 0
    force.value = [](const Points& x) { return -x(0, 0); };
    force.add_derivatives = [](const Points&, Points& gradient, std::vector<ContactBlock>&) { gradient(0, 0) -= 1; };
    return force;
  };
  testing::frame(w.scene, *stepper, w.state, w.drive, dt, pulled, extras);
  CHECK(pulled.x(0, 0) > held.x(0, 0) + 1e-3);
}

}  // namespace selvedge::test_recovering_stepper
