#include "physics/solve/euler_torque.hpp"

#include "physics/energies/measures.hpp"
#include "physics/steppers/icm_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_euler_torque {

using testing::make_world;
using testing::sheet;
using testing::World;

namespace {

constexpr double h = 1.0 / 60;
const Vec3 gravity(0, -9.81, 0);

// On one corner, an oblong sheet: no mirror keeps it from turning.
World on_a_corner() {
  testing::Sheet oblong = sheet(6, 0.5, 0);
  oblong.x.col(2) *= 0.6;
  World w = make_world(oblong);
  w.scene.pins = {0};
  w.drive.pins = w.state.x.topRows(1);
  return w;
}

double turn(const World& w, const State& s) {  // [rad/s]
  const Points arms = s.x.rowwise() - w.drive.pins.row(0);
  const Eigen::VectorXd masses = lumped_masses(w.scene);
  return angular_momentum(w.scene, arms, s.v).y() / masses.dot(arms.col(0).cwiseAbs2() + arms.col(2).cwiseAbs2());
}

double fastest_turn(const World& w, Stepper& stepper, int frames) {
  State state = w.state, to;
  double fastest = 0;
  for (int f = 0; f < frames; ++f) {
    REQUIRE(testing::frame(w.scene, stepper, state, w.drive, h, to).status == StepStatus::accepted);
    std::swap(state, to);
    fastest = std::max(fastest, std::abs(turn(w, state)));
  }
  return fastest;
}

}  // namespace

TEST_CASE("a sheet that is let go on one pin does not begin to turn", "[euler_torque]") {
  const World w = on_a_corner();
  CHECK(fastest_turn(w, *testing::conventional(w.scene), 240) < 0.05);
  CHECK(fastest_turn(w, *make_icm_stepper(w.scene, {}), 120) < 0.05);
}

TEST_CASE("what turns about its pin turns on", "[euler_torque]") {
  World w = on_a_corner();
  w.state.x.col(1).swap(w.state.x.col(2));  // upright below its pin, which is at one end
  w.drive.pins = w.state.x.topRows(1);
  w.state.x.col(1) = -(w.state.x.col(1).array() - w.drive.pins(0, 1)).abs() + w.drive.pins(0, 1);
  for (int i = 0; i < w.state.x.rows(); ++i)
    w.state.v.row(i) = Vec3::UnitY().cross(row(w.state.x, i) - w.drive.pins.row(0).transpose()).transpose();
  const auto stepper = testing::conventional(w.scene);
  REQUIRE(turn(w, w.state) == Approx(1));
  State state = w.state, to;
  const Points arms = w.state.x.rowwise() - w.drive.pins.row(0);
  const double momentum = angular_momentum(w.scene, arms, w.state.v).y();
  for (int f = 0; f < 30; ++f) {
    REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, h, to).status == StepStatus::accepted);
    std::swap(state, to);
  }
  const Points now = state.x.rowwise() - w.drive.pins.row(0);
  CHECK(angular_momentum(w.scene, now, state.v).y() == Approx(momentum).epsilon(0.1));
}

TEST_CASE("two pins side by side hold a cloth, and wind turns it: nothing is taken back", "[euler_torque]") {
  World w = on_a_corner();
  const Points v0 = 2 * w.state.x, x1 = w.state.x + Points::Constant(w.state.x.rows(), 3, 0.01);
  Points v1 = w.state.x;
  v1.col(0).swap(v1.col(2));
  const auto left = [&](const Vec3& g, const Vec3& wind = Vec3::Zero()) {
    const StepProblem step{h, &w.state.x, &v0, nullptr, g, wind, {}};
    Points v = v1;
    EulerTorque(w.scene).take_back(step, x1, Points::Zero(v.rows(), 3), v);
    return v;
  };
  CHECK(left(gravity) != v1);
  CHECK(left(Vec3::Zero()) == v1);
  CHECK(left(gravity, Vec3::UnitX()) == v1);
  w.scene.pins = {0, 1};
  CHECK(left(gravity) == v1);
}

}  // namespace selvedge::test_euler_torque
