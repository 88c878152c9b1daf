#include "physics/solve/energy_balance.hpp"

#include <cmath>

#include "tests/physics/worlds.hpp"

namespace selvedge::test_energy_balance {

using testing::make_world;
using testing::sheet;
using testing::World;

namespace {

constexpr double dt = 1.0 / 60;

// The sheet as it is, moved and with a speed.
State moved(const World& w, double up, double speed) {
  State to = w.state;
  to.time = dt;
  to.x.col(1).array() += up;
  to.v.col(1).setConstant(speed);
  return to;
}

EnergyGain judged(const World& w, State to) { return EnergyBalance(w.scene)(w.state, w.drive, to); }

}  // namespace

TEST_CASE("energy balance: speed and height from nowhere, and a little of them", "[energy_balance]") {
  const World w = make_world(sheet(6, 0.4, 0));
  const double weight = 9.81 * lumped_masses(w.scene).sum(), edge = mean_edge_length(w.scene);
  const EnergyGain lifted = judged(w, moved(w, edge, 0));
  CHECK(lifted.gain == Approx(weight * edge));
  CHECK(lifted.work == 0);
  CHECK(lifted.from_nowhere());
  CHECK(judged(w, moved(w, 0, 3)).from_nowhere());
  CHECK_FALSE(judged(w, moved(w, 0.1 * edge, 0)).from_nowhere());
  CHECK_FALSE(judged(w, moved(w, -1, 4)).from_nowhere());
  CHECK(judged(w, moved(w, 0, 1e200)).from_nowhere());  // the energy is not a number
}

TEST_CASE("energy balance: little by little is found out, and what is lost again is no gain", "[energy_balance]") {
  const World w = make_world(sheet(6, 0.4, 0));
  EnergyBalance balance(w.scene);
  const double edge = mean_edge_length(w.scene);
  const auto found = [&](const std::vector<double>& heights) {
    State from = w.state;
    std::vector<bool> steps;
    for (const double height : heights) {
      State to = moved(w, height * edge, 0);
      steps.push_back(balance(from, w.drive, to).from_nowhere());
      from = to;
    }
    return steps;
  };
  using Found = std::vector<bool>;
  CHECK(found({0.1, 0.2, 0.29, 0.31, 0.4}) == Found{false, false, false, true, false});
  CHECK(found({0.2, 0, 0.2, 0, 0.2, 0.25}) == Found(6, false));
  CHECK(found({-1, -0.8, -0.6}) == Found{false, false, true});
}

TEST_CASE("energy balance: what pins do is no gain from nowhere", "[energy_balance]") {
  World w = make_world(sheet(6, 0.4, 0));
  for (int i = 0; i < w.state.x.rows(); ++i) w.scene.pins.push_back(i);
  const EnergyGain lifted = judged(w, moved(w, 0.3, 3));
  CHECK(lifted.work > lifted.gain);
  CHECK_FALSE(lifted.from_nowhere());
  CHECK(lifted.nowhere == 0);
}

TEST_CASE("energy balance: elements that a stepper holds give the same bits as its own", "[energy_balance]") {
  for (const BendingModel bending : {BendingModel::curvature, BendingModel::hinge})
    for (const bool flat : {true, false}) {
      World w = make_world(sheet(6, 0.4, 0));
      w.scene.cloths[0].material.bending_model = bending;
      w.scene.rest_is_flat = flat;
      w.scene.springs = {{0, 48, 0.3, 10}};
      w.scene.pins = {0};
      const Elastic elastic = make_elastic(w.scene);
      State to = moved(w, 0.1, 1);
      for (int i = 0; i < to.x.rows(); ++i) to.x.row(i) += 0.02 * std::sin(5.0 * i) * Vec3(1, 2, 3).transpose();
      State again = to;
      const EnergyGain own = EnergyBalance(w.scene)(w.state, w.drive, to);
      const EnergyGain shared = EnergyBalance(w.scene, elastic)(w.state, w.drive, again);
      CHECK(own.work > 0);
      CHECK(own.gain == shared.gain);
      CHECK(own.work == shared.work);
      CHECK(own.nowhere == shared.nowhere);
      CHECK(own.tolerated == shared.tolerated);
    }
}

TEST_CASE("energy balance: the doubt stands on accepted steps, beside other doubts", "[energy_balance]") {
  const World w = make_world(sheet(6, 0.4, 0));
  const auto labelled = [&](StepStatus status, Doubts doubts, double speed) {
    StepReport report;
    report.status = status;
    report.doubts = doubts;
    State to = moved(w, 0, speed);
    EnergyBalance(w.scene).label(w.state, w.drive, to, report);
    CHECK(report.reason == Reason::none);
    return report.doubts;
  };
  const Doubts rough{.not_converged = true}, crossing{.penetrating = true};
  CHECK(labelled(StepStatus::accepted, {}, 3) == Doubts{.energy_gain = true});
  CHECK(labelled(StepStatus::accepted, rough, 3) == Doubts{.not_converged = true, .energy_gain = true});
  CHECK(labelled(StepStatus::accepted, crossing, 3) == Doubts{.penetrating = true, .energy_gain = true});
  CHECK(labelled(StepStatus::rejected, {}, 3) == Doubts{});
  CHECK(labelled(StepStatus::accepted, {}, 0) == Doubts{});
}

}  // namespace selvedge::test_energy_balance
