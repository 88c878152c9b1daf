#include <random>

#include "collision/audit.hpp"
#include "collision/untangle.hpp"
#include "physics/recovery.hpp"
#include "tests/physics/worlds.hpp"

using namespace selvedge;
using testing::add_obstacle;
using testing::make_world;
using testing::sheet;
using testing::World;

namespace {

// A closed block round `centre`, its faces cut in two.
testing::Sheet block(const Vec3& centre, double half) {
  testing::Sheet body;
  body.x.resize(8, 3);
  for (int v = 0; v < 8; ++v)
    body.x.row(v) = (centre + half * Vec3(v & 1 ? 1 : -1, v & 2 ? 1 : -1, v & 4 ? 1 : -1)).transpose();
  body.triangles.resize(12, 3);
  body.triangles << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5,
      3, 7, 5;
  return body;
}

// Without gravity, within 20 frames, and no vertex faster than 0.1 m a frame that started tangled.
void check_recovers(World w) {
  w.drive.acceleration.setZero();
  State state = w.state;
  double fastest = 0;
  const auto stepper = make_conventional_stepper(w.scene, {});
  for (int frame = 0; frame < 20 && !(frame > 0 && state.clean); ++frame) {
    State to;
    REQUIRE(stepper->step(state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    fastest = std::max(fastest, (to.x - state.x).rowwise().norm().maxCoeff());
    state = to;
  }
  CHECK(state.clean);
  CHECK(fastest < 0.1);
}

ContactWorld with_its_obstacle(const World& w) {
  return make_contact_world(w.scene.surface, {&w.scene.obstacles[0].surface}, true);
}

}  // namespace

TEST_CASE("recovery: two sheets that start through each other get clean and stay so", "[recovery]") {
  const auto level = sheet(10, 0.4, 0);
  testing::Sheet upright = testing::tilted(sheet(9, 0.2, 0), 1.5);
  upright.x.col(0).array() += 0.013;
  upright.x.col(1).array() += 0.06;
  World w = make_world(testing::join(level, upright));
  REQUIRE(audit(w.scene.surface, w.state.x, {}).intersecting_pairs() > 0);
  check_recovers(w);
}

TEST_CASE("recovery: cloth that starts inside a closed body comes out at a bounded speed", "[recovery]") {
  World w = make_world(sheet(12, 0.4, 0.04));
  add_obstacle(w, block({0.01, 0, 0.02}, 0.06));
  std::vector<AuditBody> bodies{{&w.scene.obstacles[0].surface, &w.state.obstacles[0]}};
  REQUIRE(audit(w.scene.surface, w.state.x, bodies).inside_vertices > 0);
  check_recovers(w);
}

TEST_CASE("recovery: a clean start is left as it is", "[recovery]") {
  World w = make_world(sheet(6, 0.4, 0.1));
  add_obstacle(w, block({0, 0, 0}, 0.06));
  const ContactWorld world = with_its_obstacle(w);
  Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  const Points before = nodes;
  CHECK_FALSE(recover(world, Eigen::VectorXd::Ones(nodes.rows()), 1, {}, nodes).left.any());
  CHECK(nodes == before);
}

TEST_CASE("recovery: a body that crosses itself is switched off there and nowhere else", "[recovery]") {
  World w = make_world(sheet(12, 0.5, 0.12));
  // Two blocks that overlap at their corners: one obstacle of two closed parts.
  add_obstacle(w, testing::join(block({-0.05, 0, 0}, 0.06), block({0.05, 0.011, 0.013}, 0.06)));
  const ContactWorld world = with_its_obstacle(w);
  const Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  SelfCrossings crossings(world);
  Exemption exemption;
  crossings.switch_off(nodes, nodes, exemption);
  REQUIRE_FALSE(exemption.off.empty());
  CHECK_FALSE(exemption.cloth());
  CHECK(std::count(exemption.off.begin(), exemption.off.begin() + w.scene.surface.vertex_count, 1) == 0);
  const testing::Run r = testing::run(w, 30);
  CHECK(r.state.x.allFinite());
  CHECK(r.held == 0);
  CHECK(r.passed_through == 0);
}

TEST_CASE("recovery: what cannot be parted is not pushed, the rest is", "[recovery]") {
  testing::Sheet ball = sheet(4, 0.2, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-0.04, 0.04);
  for (int v = 0; v < ball.x.rows(); ++v) ball.x.row(v) << within(random), within(random), within(random);
  const World w = make_world(ball);
  const ContactWorld world = make_contact_world(w.scene.surface, {}, true);
  const UntangleResult parted = untangle(w.scene.surface, w.state.x, {});
  REQUIRE(parted.pairs_after > 0);
  const Exemption there = find_exemption(world, parted.x);
  Points nodes = w.state.x;
  recover(world, Eigen::VectorXd::Ones(nodes.rows()), 0.01, {}, nodes);
  int pushed = 0;
  for (int v = 0; v < nodes.rows(); ++v) {
    const bool moved = nodes.row(v) != w.state.x.row(v);
    CHECK_FALSE((moved && there.self[v]));
    pushed += moved;
  }
  CHECK(pushed > 0);
}

TEST_CASE("recovery: what is left alone is every pair with a tangled vertex", "[recovery]") {
  World w = make_world(sheet(2, 0.4, 0));
  add_obstacle(w, block({0, -0.2, 0}, 0.06));
  const ContactWorld world = with_its_obstacle(w);
  Exemption exemption;
  CHECK_FALSE(exemption.leaves_alone(world, {0, 1, 4, 5}));
  exemption.self.assign(9, 0);
  exemption.self[4] = 1;
  CHECK(exemption.leaves_alone(world, {0, 1, 4, 5}));
  CHECK_FALSE(exemption.leaves_alone(world, {0, 1, 2, 5}));
  CHECK_FALSE(exemption.leaves_alone(world, {4, 9, 10, 11}));
  exemption.body.assign(9, 0);
  exemption.body[4] = 1;
  CHECK(exemption.leaves_alone(world, {4, 9, 10, 11}));
  exemption.off.assign(world.node_count, 0);
  exemption.off[9] = exemption.off[10] = 1;
  CHECK_FALSE(exemption.leaves_alone(world, {0, 9, 10, 11}));
  exemption.off[11] = 1;
  CHECK(exemption.leaves_alone(world, {0, 9, 10, 11}));
}

TEST_CASE("recovery: a body that jumps farther than its size is not swept along, and what it lands on gets clean",
          "[recovery]") {
  World w = make_world(sheet(12, 0.4, 0));
  add_obstacle(w, block({3, 0, 0}, 0.03));
  w.drive.acceleration.setZero();
  const Points there = block({0.01, 0, 0.02}, 0.03).x;
  const auto stepper = make_conventional_stepper(w.scene, {});
  State state = w.state, to;
  w.drive.obstacles = {there};
  StepReport report = stepper->step(state, w.drive, 1.0 / 30, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.collision.jumped == 1);
  CHECK(to.obstacles[0] == there);
  CHECK((to.x - state.x).rowwise().norm().maxCoeff() < 0.1);  // a sweep at 90 m/s would carry it off
  for (int frame = 0; frame < 20; ++frame) {
    state = to;
    report = stepper->step(state, w.drive, 1.0 / 30, to);
    CHECK(report.collision.jumped == 0);
  }
  CHECK(to.clean);
}

TEST_CASE("recovery: a fast body that does not jump sweeps the cloth along", "[recovery]") {
  World w = make_world(sheet(12, 0.4, 0));
  add_obstacle(w, block({0, -0.3, 0}, 0.06));
  w.drive.acceleration.setZero();
  w.drive.obstacles = {block({0, 1, 0}, 0.06).x};
  State to;
  const StepReport report = make_conventional_stepper(w.scene, {})->step(w.state, w.drive, 1.0 / 30, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.collision.jumped == 0);
  CHECK(to.clean);
  CHECK(to.x.col(1).maxCoeff() > 1);
}
