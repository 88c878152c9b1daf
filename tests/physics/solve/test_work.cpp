#include "physics/solve/work.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_work {

using testing::add_obstacle;
using testing::make_world;
using testing::sheet;
using testing::World;

namespace {

struct Books {
  double gain = 0;               // of energy [J]
  Work work, of_world, of_list;  // the last with a list of pairs that goes on from frame to frame
};

// The conventional stepper's energy and the bound on its work over some frames.
Books books(const World& w, int frames, const std::function<Drive(int frame)>& drive) {
  const auto stepper = make_recovering_conventional_stepper(w.scene, {});
  const Elastic elastic = make_elastic(w.scene);
  WorkBound bound(w.scene, elastic);
  State state = w.state, to;
  PathPairs listed;
  const auto energy = [&](const State& s) { return energies(w.scene, s.x, s.v, w.drive.acceleration).total(); };
  Books result;
  result.gain = -energy(state);
  for (int f = 1; f <= frames; ++f) {
    const Drive d = drive(f);
    REQUIRE(testing::frame(w.scene, *stepper, state, d, 1.0 / 60, to).status == StepStatus::accepted);
    result.work += bound(state, to, d);
    result.of_world += bound.of_world(state, to, d);
    result.of_list += bound.of_world(state, to, d, &listed);
    std::swap(state, to);
  }
  result.gain += energy(state);
  return result;
}

}  // namespace

TEST_CASE("work: a fall takes none, and gains none", "[work]") {
  const World w = make_world(sheet(6, 0.4, 0));
  const Books fall = books(w, 10, [&](int) { return w.drive; });
  CHECK(fall.work.total() == 0);
  CHECK(fall.gain < 1e-9);  // implicit Euler falls a little deep
}

TEST_CASE("work: a stretched spring that lets go gives what it held, and no more", "[work]") {
  World w = make_world(testing::join(sheet(4, 0.2, 0), sheet(4, 0.2, 0.5)));
  w.drive.acceleration.setZero();
  w.scene.contact.self = false;
  w.scene.springs = {{12, 25 + 12, 0.3, 0.5}};  // the middles
  const double held = energies(w.scene, w.state.x, w.state.v, w.drive.acceleration).total();
  REQUIRE(held == Approx(0.5 * 0.5 * 0.04));
  const Books pull = books(w, 10, [&](int) { return w.drive; });
  CHECK(pull.work.total() == 0);
  CHECK(pull.gain < 0);
  CHECK(pull.gain > -0.9 * held);
}

TEST_CASE("work: what hangs on a spring is lifted by the work of its other end's pins", "[work]") {
  World w = make_world(testing::join(sheet(2, 0.1, 0), sheet(2, 0.1, -0.2)));
  for (int i = 0; i < 9; ++i) w.scene.pins.push_back(i);
  w.scene.contact.self = false;
  w.scene.springs = {{4, 9 + 4, 0.1, 2}};
  w.scene.cloths[0].material.stiffness_damping = 0.01;
  const auto lifted = [&](double speed) {
    return [&w, speed](int frame) {
      Drive d = w.drive;
      d.pins = w.state.x.topRows(9);
      d.pins.col(1).array() += speed * frame / 60;
      return d;
    };
  };
  const Books hang = books(w, 60, lifted(0)), lift = books(w, 60, lifted(1));
  CHECK(hang.work.total() == 0);
  CHECK(hang.gain < 0);
  const double weight = 9.81 * lumped_masses(w.scene).sum();  // both are lifted by a metre
  CHECK(lift.gain > 0.8 * weight);
  CHECK(lift.gain < lift.work.total());
  CHECK(lift.work.total() < 4 * weight);
}

TEST_CASE("work: what lifts a sheet by its pins is bounded, and not by much more than the lift", "[work]") {
  World w = make_world(sheet(6, 0.4, 0));
  w.scene.pins = {0, 1, 2, 3, 4, 5, 6};
  const auto lifted = [&](int frame) {
    Drive d = w.drive;
    d.pins.resize(static_cast<Eigen::Index>(w.scene.pins.size()), 3);
    for (std::size_t p = 0; p < w.scene.pins.size(); ++p)
      d.pins.row(static_cast<Eigen::Index>(p)) =
          w.state.x.row(w.scene.pins[p]) + Eigen::RowVector3d(0, 1.0 * frame / 60, 0);
    return d;
  };
  const Books lift = books(w, 60, lifted);
  const double weight = 9.81 * lumped_masses(w.scene).sum();  // lifted by a metre, less what hangs below
  CHECK(lift.gain > 0.5 * weight);
  CHECK(lift.gain < lift.work.total());
  CHECK(lift.work.total() == lift.work.pins);
  CHECK(lift.work.pins < 4 * weight);
  CHECK(lift.gain < lift.of_world.total());
  CHECK(lift.of_world.total() <= lift.work.total());
}

TEST_CASE("work: a plate that lifts a sheet does it, a plate at rest none", "[work]") {
  World w = make_world(sheet(6, 0.4, 0.0021));
  add_obstacle(w, testing::sheet(2, 1, 0));
  const auto raised = [&](double speed) {
    return [&w, speed](int frame) {
      Drive d = w.drive;
      d.obstacles[0].col(1).array() += speed * frame / 60;
      return d;
    };
  };
  const Books rest = books(w, 30, raised(0)), lift = books(w, 30, raised(0.5));
  CHECK(rest.work.obstacles == 0);
  CHECK(rest.gain < rest.work.response + 1e-6);
  CHECK(lift.gain > 0.2 * 9.81 * lumped_masses(w.scene).sum() * 0.5);
  CHECK(lift.gain < lift.work.total());
  CHECK(lift.work.obstacles > 0.9 * lift.work.total());
  CHECK(lift.gain < lift.of_world.total());
  CHECK(lift.of_list.obstacles == lift.of_world.obstacles);  // a list that was kept decides nothing
  CHECK(lift.of_list.total() == lift.of_world.total());
  CHECK(lift.of_world.total() <= lift.work.total());
}

TEST_CASE("work: a proposal's own stretch and speed are no work of the world", "[work]") {
  constexpr double dt = 1.0 / 60;
  World w = make_world(sheet(6, 0.4, 0));
  w.scene.pins = {0, 1, 2, 3, 4, 5, 6};
  const double weight = 9.81 * lumped_masses(w.scene).sum(), rise = 0.1 * dt;
  State from = w.state, to = w.state;
  from.v.col(1).setConstant(rise / dt);
  to.time = from.time + dt;
  to.x.col(1).array() += rise;
  to.x.bottomRows(42).col(2).array() += 0.01;  // the cloth is drawn off its pins
  to.v = (to.x - from.x) / dt;
  const Elastic hanging = make_elastic(w.scene);
  WorkBound pinned(w.scene, hanging);
  CHECK(pinned(from, to, w.drive).pins > 10 * weight * rise);
  CHECK(pinned.of_world(from, to, w.drive).pins < 2 * weight * rise);

  // Wind of 1 m/s does not throw cloth at 30 m/s.
  World blown = make_world(sheet(6, 0.4, 0));
  blown.scene.wind.on = true;
  blown.drive.wind = {0, 1, 0};
  State thrown = blown.state;
  thrown.time = dt;
  thrown.v.col(1).setConstant(30);
  thrown.x += dt * thrown.v;
  const Elastic floating = make_elastic(blown.scene);
  WorkBound air(blown.scene, floating);
  const double moving = 0.5 * lumped_masses(blown.scene).sum();  // at 1 m/s [J]
  CHECK(air(blown.state, thrown, blown.drive).wind > 10 * moving);
  CHECK(air.of_world(blown.state, thrown, blown.drive).wind < 2 * moving);

  // Nor does a plate that rises at 1 m/s.
  World pushed = make_world(sheet(6, 0.4, 0.0021));
  add_obstacle(pushed, testing::sheet(2, 1, 0));
  thrown.obstacles = pushed.state.obstacles;
  thrown.obstacles[0].col(1).array() += dt;
  thrown.x = pushed.state.x + dt * thrown.v;
  const Elastic lying = make_elastic(pushed.scene);
  WorkBound plate(pushed.scene, lying);
  CHECK(plate(pushed.state, thrown, pushed.drive).obstacles > 10 * moving);
  CHECK(plate.of_world(pushed.state, thrown, pushed.drive).obstacles < 4 * moving);
}

TEST_CASE("work: velocity from nowhere is not covered", "[work]") {
  const World w = make_world(sheet(6, 0.4, 0));
  const Elastic elastic = make_elastic(w.scene);
  WorkBound bound(w.scene, elastic);
  State to = w.state;
  to.time = 1.0 / 60;
  to.v.col(1).setConstant(3);
  to.x += to.v / 60;
  CHECK(bound(w.state, to, w.drive).total() == 0);
}

}  // namespace selvedge::test_work
