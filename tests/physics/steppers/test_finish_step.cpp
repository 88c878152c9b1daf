#include "physics/steppers/finish_step.hpp"

#include "physics/frame/frame_audits.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_finish_step {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;

World over_plate() {
  World w = testing::sheet_over_plate();
  w.state.time = 0.5;
  w.state.frame = 7;
  return w;
}

StepEnd straight_on(const World& w) { return {w.state.x, w.state.v, w.drive.obstacles}; }

}  // namespace

TEST_CASE("finish_step: fills in all that a state must have", "[finish_step]") {
  const World w = over_plate();
  State to;
  to.cut_out = {3};  // what was there before is gone
  to.memory = {{"old.block", MemoryRows::Zero(1, 1)}};
  StepEnd end = straight_on(w);
  end.x.col(1).array() -= 0.01;
  end.v.setConstant(0.5);
  end.memory = {{"new.block", MemoryRows::Ones(1, 2)}};
  StepReport report;
  finish_step(w.state, w.drive, dt, end, to, report);
  CHECK(report.status == StepStatus::accepted);
  CHECK(to.time == w.state.time + dt);
  CHECK(to.frame == 8);
  CHECK(to.x == end.x);
  CHECK(to.v == end.v);
  CHECK(to.obstacles == w.drive.obstacles);
  CHECK((!to.clean && !to.pinched && to.cut_out.empty()));  // nobody has looked
  REQUIRE(to.memory.size() == 1);
  CHECK(to.memory[0].name == "new.block");
  CHECK_FALSE(report.audit);
  CHECK(report.collision.obstacle_lag == 0);
  CHECK(report.path.start == gather_nodes(w.state.x, w.state.obstacles));
  REQUIRE(report.path.substeps.size() == 1);
  CHECK(report.path.substeps[0].nodes == gather_nodes(to.x, to.obstacles));
}

TEST_CASE("finish_step: names obstacles that lag by more than rounding", "[finish_step]") {
  const World w = over_plate();
  State to;
  StepReport lagging, rounded;
  StepEnd end = straight_on(w);
  end.obstacles[0](0, 2) += 1e-3;
  finish_step(w.state, w.drive, dt, end, to, lagging);
  CHECK(to.pinched);
  CHECK(lagging.collision.obstacle_lag == Approx(1e-3));
  end.obstacles[0](0, 2) = w.drive.obstacles[0](0, 2) + 1e-16;
  finish_step(w.state, w.drive, dt, end, to, rounded);
  CHECK_FALSE(to.pinched);
  CHECK(rounded.collision.obstacle_lag == 0);
}

TEST_CASE("resolve_proposal: what goes through the plate on the way ends above it", "[finish_step]") {
  const World w = over_plate();
  ContactStage stage(w.scene);
  Points x = w.state.x;
  x.col(1).array() -= 0.2;
  std::vector<Points> obstacles = w.drive.obstacles;
  const ResolveReport report = resolve_proposal(stage, stage.options, w.state, nullptr, x, obstacles);
  CHECK(report.clean);
  CHECK(report.found > 0);
  CHECK(report.impulses + report.zones > 0);
  CHECK(x.col(1).minCoeff() > 0);
  CHECK(obstacles == w.drive.obstacles);
  AuditMemory audits;
  CHECK(audit_path(stage.world, {}, gather_nodes(w.state.x, w.state.obstacles), gather_nodes(x, obstacles), audits)
            .passed_through() == 0);

  Points free = w.state.x;
  free.col(1).array() += 0.01;
  const Points asked = free;
  const ResolveReport idle = resolve_proposal(stage, stage.options, w.state, nullptr, free, obstacles);
  CHECK((idle.clean && idle.found == 0 && idle.largest_zone == 0));
  CHECK(free == asked);
}

TEST_CASE("resolve_proposal: what is left alone goes through, and only in that call", "[finish_step]") {
  const World w = over_plate();
  ContactStage stage(w.scene);
  Exemption all;
  all.body.assign(static_cast<std::size_t>(w.state.x.rows()), 1);
  std::vector<Points> obstacles = w.drive.obstacles;
  Points down = w.state.x;
  down.col(1).array() -= 0.2;
  const Points asked = down;
  CHECK(resolve_proposal(stage, stage.options, w.state, &all, down, obstacles).found == 0);
  CHECK(down == asked);
  CHECK(resolve_proposal(stage, stage.options, w.state, nullptr, down, obstacles).found > 0);
  CHECK(down.col(1).minCoeff() > 0);
}

TEST_CASE("resolve_proposal: zones are counted, and with impulses alone the rest is said to be left", "[finish_step]") {
  World w = make_world(testing::join(testing::sheet(4, 0.2, 0.05), testing::sheet(4, 0.2, 0.06)));
  add_obstacle(w, testing::sheet(2, 0.6, 0));
  ContactStage stage(w.scene);
  Points x = w.state.x;
  x.topRows(25).col(1).array() -= 0.049;
  x.bottomRows(25).col(1).array() -= 0.3;
  std::vector<Points> obstacles = w.drive.obstacles;
  Points given_up = x;
  ResolveOptions options = stage.options;
  options.last_resort = false;
  options.zone_rounds = 0;
  options.impulse_rounds = 1;
  CHECK_FALSE(resolve_proposal(stage, options, w.state, nullptr, given_up, obstacles).clean);
  options = stage.options;
  options.impulse_rounds = 0;
  const ResolveReport report = resolve_proposal(stage, options, w.state, nullptr, x, obstacles);
  CHECK(report.clean);
  CHECK(report.zones > 0);
  CHECK((report.largest_zone > 4 && report.largest_zone <= 50));
}

}  // namespace selvedge::test_finish_step
