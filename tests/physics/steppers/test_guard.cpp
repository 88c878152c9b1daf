#include "physics/steppers/guard.hpp"

#include "tests/physics/spoiled_steps.hpp"

// What the guard admits and refuses, on steps that the conventional stepper has made and on the same ones spoiled.
namespace selvedge::test_guard {

using testing::RecordedStep;
using testing::Spoil;
using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

Verdict verdict_of(Guard& guard, ContactStage& stage, const RecordedStep& step, const Points& x) {
  GuardMeasures measures;
  return judge(
      guard, step.from, step.drive, dt, x, [&] { return touching_vertices(stage, step.from, step.drive.obstacles, x); },
      measures);
}

}  // namespace

TEST_CASE("guard: conventional steps are admitted, and spoiled ones refused", "[guard]") {
  const World w = testing::swinging_sheet();
  const std::vector<RecordedStep> steps = testing::recorded(w, 24);
  Guard guard(w.scene, {});
  ContactStage stage(w.scene);
  for (std::size_t k = 4; k < steps.size(); k += 3) {
    const RecordedStep& step = steps[k];
    INFO("frame " << k);
    CHECK(verdict_of(guard, stage, step, step.to.x) == Verdict::admitted);
    for (const auto& [name, spoil] : testing::spoils()) {
      const Points x = spoil(w.scene, step);
      const double error = (x - step.to.x).rowwise().norm().maxCoeff();
      INFO(name << ", largest vertex error " << error);
      if (!(error < 5e-3)) CHECK(verdict_of(guard, stage, step, x) != Verdict::admitted);
    }
  }
}

TEST_CASE("guard: the cheapest test that fails names the reason", "[guard]") {
  const World w = testing::swinging_sheet();
  const RecordedStep step = testing::recorded(w, 8).back();
  Guard guard(w.scene, {});
  int asked = 0;
  GuardMeasures measures;
  const auto verdict = [&](const Points& x) {
    return judge(
        guard, step.from, step.drive, dt, x,
        [&] {
          ++asked;
          return std::vector<char>{};
        },
        measures);
  };
  Points x = step.to.x;
  x(3, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(verdict(x) == Verdict::not_finite);
  x = step.to.x;
  x(x.rows() - 1, 2) += 1;
  CHECK(verdict(x) == Verdict::moved_too_far);
  CHECK(asked == 0);
  guard.options.stretch = guard.options.stretch_growth = 0.5;
  CHECK(verdict(step.to.x) == Verdict::overstretched);
  guard.options = {};
  guard.options.energy_growth = -1e6;
  CHECK(verdict(step.to.x) == Verdict::energy_gain);
  CHECK(asked == 0);
  guard.options = {};
  guard.options.imbalance = 0;
  CHECK(verdict(step.to.x) == Verdict::unbalanced);
  CHECK(asked == 1);
  guard.options = {};
  CHECK(verdict(step.to.x) == Verdict::admitted);
}

TEST_CASE("guard: cloth that glides slowly does not stop or turn back without a force", "[guard]") {
  World w = testing::make_world(testing::sheet(6, 0.2, 0));
  w.drive.acceleration.setZero();
  w.state.v = Points::Constant(w.state.x.rows(), 3, 0.05);  // 2.9 mm a step
  Guard guard(w.scene, {});
  ContactStage stage(w.scene);
  const Points way = dt * w.state.v;
  const RecordedStep step{w.state, w.state, w.state, w.drive};
  CHECK(verdict_of(guard, stage, step, w.state.x + way) == Verdict::admitted);
  CHECK(verdict_of(guard, stage, step, w.state.x) == Verdict::unbalanced);
  CHECK(verdict_of(guard, stage, step, w.state.x - way) == Verdict::unbalanced);
  // Gravity explains that it turns.
  const RecordedStep thrown{w.state, w.state, w.state, [&] {
                              Drive drive = w.drive;
                              drive.acceleration = -1.5 * Vec3::Constant(0.05) / dt;
                              return drive;
                            }()};
  CHECK(verdict_of(guard, stage, thrown, w.state.x - 0.5 * way) == Verdict::admitted);
}

TEST_CASE("guard: cloth that nothing holds or touches falls as gravity says", "[guard]") {
  World w = testing::make_world(testing::sheet(6, 0.2, 0));
  w.state.v.col(1).setConstant(-1);
  Guard guard(w.scene, {});
  ContactStage stage(w.scene);
  const RecordedStep step{w.state, w.state, w.state, w.drive};
  const auto flown = [&](double share) -> Points {
    return (w.state.x + dt * w.state.v).rowwise() + share * dt * dt * w.drive.acceleration.transpose();
  };
  CHECK(verdict_of(guard, stage, step, flown(1)) == Verdict::admitted);    // one implicit step
  CHECK(verdict_of(guard, stage, step, flown(0.5)) == Verdict::admitted);  // an exact flight
  CHECK(verdict_of(guard, stage, step, flown(0)) == Verdict::unbalanced);
  CHECK(verdict_of(guard, stage, step, flown(1.5)) == Verdict::unbalanced);
  CHECK(verdict_of(guard, stage, step, flown(-0.5)) == Verdict::unbalanced);
  // What holds it may carry it.
  w.scene.pins = {0};
  w.drive.pins = w.state.x.topRows(1) + dt * w.state.v.topRows(1);
  Guard held(w.scene, {});
  ContactStage beside(w.scene);
  CHECK(verdict_of(held, beside, {w.state, w.state, w.state, w.drive}, flown(0)) == Verdict::admitted);
}

TEST_CASE("guard: what touches is left out of the residual", "[guard]") {
  World w = testing::make_world(testing::sheet(6, 0.2, 0.003));
  add_obstacle(w, testing::sheet(3, 0.6, 0));
  w.scene.contact.thickness = 3e-3;
  Guard guard(w.scene, {});
  ContactStage stage(w.scene);
  const auto touching = touching_vertices(stage, w.state, w.drive.obstacles, w.state.x);
  CHECK(std::ranges::count(touching, 1) == std::ssize(touching));
  // The sheet lies still on the plate, which carries it: nothing is known to be out of balance.
  GuardMeasures lying = measure(guard, w.state, w.drive, dt, w.state.x, [&] { return touching; });
  CHECK(lying.in_contact == 1);
  CHECK(lying.imbalance == 0);
  // In the air it would be: gravity is not answered.
  lying = measure(guard, w.state, w.drive, dt, w.state.x, {});
  CHECK(lying.in_contact == 0);
  CHECK(lying.decrement > 0);
}

}  // namespace selvedge::test_guard
