#include <numbers>
#include <random>

#include "collision/audit/audit.hpp"
#include "collision/untangle/caught.hpp"
#include "collision/untangle/find_exemption.hpp"
#include "collision/untangle/untangle.hpp"
#include "physics/energies/measures.hpp"
#include "physics/recovery/recovery.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_recovery {

using testing::add_obstacle;
using testing::block;
using testing::make_world;
using testing::sheet;
using testing::with_its_obstacle;
using testing::World;

namespace {

// Without gravity, within 20 frames, and no vertex faster than 0.1 m a frame that started tangled.
void check_recovers(World w) {
  w.drive.acceleration.setZero();
  State state = w.state;
  double fastest = 0;
  const auto stepper = make_recovering_conventional_stepper(w.scene, {});
  for (int frame = 0; frame < 20 && !(frame > 0 && state.clean); ++frame) {
    State to;
    REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    fastest = std::max(fastest, (to.x - state.x).rowwise().norm().maxCoeff());
    state = to;
  }
  CHECK(state.clean);
  CHECK(fastest < 0.1);
}

// A sheet of 4 x 4 quads, all vertices of which lie anywhere within `size` of `centre`.
World lump(unsigned seed, double size, const Vec3& centre) {
  World w = make_world(sheet(4, 0.2, 0));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-size, size);
  for (int v = 0; v < w.state.x.rows(); ++v)
    for (int k = 0; k < 3; ++k) w.state.x(v, k) = centre[k] + within(random);
  return w;
}

Vec3 mass_mean(const Scene& scene, const Points& rows) {
  return linear_momentum(scene, rows) / lumped_masses(scene).sum();
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
  CHECK_FALSE(
      recover(world, Eigen::VectorXd::Ones(nodes.rows()), 1, find_exemption(world, nodes), {}, nodes).left_alone.any());
  CHECK(nodes == before);
}

TEST_CASE("recovery: all that is tangled with a body that crosses itself is drawn to its targets", "[recovery]") {
  World w = make_world(sheet(12, 0.4, 0));
  add_obstacle(w, testing::join(block({-0.05, 0, 0}, 0.06), block({0.05, 0.011, 0.013}, 0.06)));
  w.drive.acceleration.setZero();
  w.drive.skinned_targets = w.state.x;
  w.drive.skinned_targets.col(2).array() += 0.03;
  const ContactWorld world = with_its_obstacle(w);
  const Exemption tangled = find_exemption(world, gather_nodes(w.state.x, w.state.obstacles));
  REQUIRE(std::count(tangled.body.begin(), tangled.body.end(), 1) > 20);
  State to;
  const StepReport report =
      testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene, {}), w.state, w.drive, 1.0 / 30, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.untangling == 0);  // it is trapped
  for (int v = 0; v < to.x.rows(); ++v)
    if (tangled.body[v]) CHECK((to.x.row(v) - w.drive.skinned_targets.row(v)).norm() < 0.01);
}

// Two layers over blocks that overlap; the upper one dips through the lower one there, and so do its targets.
World layers_at_a_crossing() {
  testing::Sheet dipped = sheet(16, 0.4, 0.015);
  for (int v = 0; v < dipped.x.rows(); ++v)
    if (std::hypot(dipped.x(v, 0), dipped.x(v, 2)) < 0.07) dipped.x(v, 1) = -0.015;
  World w = make_world(testing::join(sheet(12, 0.4, 0), dipped));
  add_obstacle(w, testing::join(block({-0.05, 0, 0}, 0.06), block({0.05, 0.011, 0.013}, 0.06)));
  w.drive.acceleration.setZero();
  w.drive.skinned_targets = w.state.x;
  return w;
}

int pairs_of(const World& w, const State& state) {
  return static_cast<int>(audit(w.scene.surface, state.x, {}).self_pairs.size());
}

TEST_CASE("recovery: where a body crosses itself cloth is parted from cloth, and stays so", "[recovery]") {
  const World w = layers_at_a_crossing();
  REQUIRE(pairs_of(w, w.state) > 20);
  State state = w.state;
  const auto stepper = make_recovering_conventional_stepper(w.scene, {});
  for (int frame = 0; frame < 12; ++frame) {
    State to;
    REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    state = to;
    if (frame >= 5) CHECK(pairs_of(w, state) == 0);
  }
  CHECK_FALSE(
      find_exemption(with_its_obstacle(w), gather_nodes(state.x, state.obstacles)).body.empty());  // it is trapped
}

TEST_CASE("recovery: nothing is asked of what cannot be parted, the rest goes without momentum", "[recovery]") {
  const World w = lump(7, 0.04, Vec3::Zero());
  const ContactWorld world = make_contact_world(w.scene.surface, {}, true);
  const UntangleResult parted = untangle(w.scene.surface, w.state.x, {});
  REQUIRE(parted.pairs_after > 0);
  const Exemption there = find_exemption(world, parted.x);
  const Eigen::VectorXd inverse_mass = inverse_masses(w.scene, world.node_count);
  Points nodes = w.state.x;
  const Recovery recovery = recover(world, inverse_mass, 0.01, find_exemption(world, nodes), {}, nodes);
  REQUIRE_FALSE(recovery.separations.empty());
  for (const Separation& one : recovery.separations) {
    bool can_part = false;
    double sum = 0, value = 0;
    for (int i = 0; i < one.count; ++i) {
      can_part = can_part || !there.self[one.vertex[i]];
      sum += one.weight[i];
      value += one.weight[i] * one.direction.dot(row(nodes, one.vertex[i]));
    }
    CHECK(can_part);
    CHECK(one.count <= 4);
    CHECK(std::abs(sum) < 1e-12);
    CHECK(one.least == Approx(value));
  }
  const Points moved = nodes - w.state.x;
  CHECK(moved.rowwise().norm().maxCoeff() > 0.005);
  CHECK(moved.rowwise().norm().maxCoeff() < 0.010001);
  CHECK(mass_mean(w.scene, moved).norm() < 1e-15);
}

TEST_CASE("recovery: what is parted crosses itself in no more pairs than before", "[recovery]") {
  int moved = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    World w = make_world(sheet(8, 0.4, 0));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-0.12, 0.12);  // edges are 0.05 m long
    for (int count = 0; count < 8; ++count)
      for (int k = 0, v = static_cast<int>(random() % 81); k < 3; ++k) w.state.x(v, k) += shift(random);
    const ContactWorld world = make_contact_world(w.scene.surface, {}, true);
    Points nodes = w.state.x;
    recover(world, inverse_masses(w.scene, world.node_count), 0.03, find_exemption(world, nodes), {}, nodes);
    State after = w.state;
    after.x = nodes;
    INFO("seed " << seed);
    CHECK(pairs_of(w, after) <= pairs_of(w, w.state));
    moved += nodes != w.state.x;
  }
  CHECK(moved > 10);
}

TEST_CASE("recovery: cloth tangled with itself gets out of it without momentum", "[recovery]") {
  for (const unsigned seed : {7u, 8u}) {
    World w = lump(seed, 0.04, Vec3::Zero());
    w.drive.acceleration.setZero();
    ConventionalOptions options;  // iterated solves would leave momentum of their own, with and without recovery
    options.implicit_euler.linear_tolerance = 1e-10;
    const auto stepper = make_recovering_conventional_stepper(w.scene, options);
    State state = w.state, to;
    int frame = 0;
    for (; frame < 20 && !(frame > 0 && state.clean); ++frame) {
      REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
      CHECK(mass_mean(w.scene, to.v).norm() < 2e-3);  // of 1 to 3 m/s
      state = to;
    }
    CHECK(state.clean);
    CHECK((mass_mean(w.scene, state.x) - mass_mean(w.scene, w.state.x)).norm() < 1e-3);
  }
}

TEST_CASE("recovery: a light cloth gives way to a heavy one, and both to pins", "[recovery]") {
  testing::Sheet upright = testing::tilted(sheet(9, 0.2, 0), 1.5);
  upright.x.col(0).array() += 0.013;
  upright.x.col(1).array() += 0.06;
  const auto level = sheet(10, 0.4, 0);
  World w = make_world(testing::join(level, upright));
  const int n = static_cast<int>(level.x.rows()), faces = static_cast<int>(level.triangles.rows());
  w.scene.cloths[0].vertex_count = n;
  w.scene.cloths[0].triangle_count = faces;
  w.scene.cloths.push_back(
      {"heavy", {}, n, static_cast<int>(upright.x.rows()), faces, static_cast<int>(upright.triangles.rows())});
  w.scene.cloths[1].material.density = 20;
  const ContactWorld world = make_contact_world(w.scene.surface, {}, true);
  const auto moved_by_recovery = [&] {
    Points nodes = w.state.x;
    recover(world, inverse_masses(w.scene, world.node_count), 0.03, find_exemption(world, nodes), {}, nodes);
    return Points(nodes - w.state.x);
  };
  Points moved = moved_by_recovery();
  CHECK(mass_mean(w.scene, moved).norm() < 1e-15);
  CHECK(moved.bottomRows(upright.x.rows()).norm() < 0.5 * moved.topRows(n).norm());
  for (int v = 0; v < n; ++v) w.scene.pins.push_back(v);
  moved = moved_by_recovery();
  CHECK(moved.topRows(n).norm() == 0);
  w.drive.pins = w.state.x.topRows(n);
  check_recovers(w);
}

TEST_CASE("recovery: cloth that comes out of a body leaves its momentum there", "[recovery]") {
  World w = make_world(sheet(12, 0.4, 0.04));
  add_obstacle(w, block({0.01, 0, 0.02}, 0.06));
  const ContactWorld world = with_its_obstacle(w);
  Points nodes = gather_nodes(w.state.x, w.state.obstacles);
  recover(world, inverse_masses(w.scene, world.node_count), 0.01, find_exemption(world, nodes), {}, nodes);
  const Points moved = nodes.topRows(w.state.x.rows()) - w.state.x;
  for (int v = 0; v < moved.rows(); ++v) CHECK(moved(v, 1) >= -1e-3);
  CHECK(mass_mean(w.scene, moved).y() > 1e-4);
}

TEST_CASE("recovery: a tangled cloth is put through no floor", "[recovery]") {
  for (const unsigned seed : {7u, 8u, 9u}) {
    World w = lump(seed, 0.04, {0, 0.041, 0});
    add_obstacle(w, sheet(6, 1, 0));
    const ContactWorld world = with_its_obstacle(w);
    const Eigen::VectorXd inverse_mass = inverse_masses(w.scene, world.node_count);
    Points nodes = gather_nodes(w.state.x, w.state.obstacles);
    REQUIRE(find_exemption(world, nodes).body.empty());
    const Recovery recovery = recover(world, inverse_mass, 0.03, find_exemption(world, nodes), {}, nodes);
    CHECK(recovery.left_alone.body.empty());
    CHECK(nodes.topRows(w.state.x.rows()).col(1).minCoeff() > 0);
  }
}

TEST_CASE("recovery: cloth that starts in the plane of a floor comes to lie on the side to which it points",
          "[recovery]") {
  for (const bool down : {false, true}) {
    testing::Sheet floor = sheet(6, 1, 0);
    if (down) floor.triangles.col(0).swap(floor.triangles.col(1));
    World w = make_world(sheet(8, 0.3, 0));
    add_obstacle(w, floor);
    w.drive.acceleration = Vec3(0, down ? 9.81 : -9.81, 0);
    State state = w.state, to;
    const auto stepper = make_recovering_conventional_stepper(w.scene, {});
    for (int frame = 0; frame < 15; ++frame) {
      REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
      std::swap(state, to);
    }
    CHECK(state.clean);
    const Eigen::VectorXd height = (down ? -1 : 1) * state.x.col(1);
    CHECK(height.minCoeff() > 0);
    CHECK(height.maxCoeff() < 0.01);
  }
}

TEST_CASE("recovery: layers at one place are put through no floor, whole layers neither", "[recovery]") {
  const testing::Sheet one = sheet(8, 0.3, 0.002), two = testing::join(one, one);
  World w = make_world(testing::join(two, two));
  add_obstacle(w, sheet(6, 1, 0));
  w.scene.contact.thickness = 3e-3;
  w.drive.acceleration = Vec3(0, -9.81, 0);
  State state = w.state, to;
  const auto stepper = make_recovering_conventional_stepper(w.scene, {});
  for (int frame = 0; frame < 8; ++frame) {
    REQUIRE(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).status == StepStatus::accepted);
    std::swap(state, to);
    INFO("frame " << frame);
    CHECK(state.x.col(1).minCoeff() > 0);
  }
}

TEST_CASE("recovery: left alone is what is tangled with cloth wholly, and with an obstacle at one vertex or caught",
          "[recovery]") {
  World w = make_world(sheet(2, 0.4, 0));
  add_obstacle(w, block({0, -0.2, 0}, 0.06));
  const ContactWorld world = with_its_obstacle(w);
  Exemption exemption;
  CHECK_FALSE(exemption.leaves_alone(world, {0, 1, 4, 5}));
  exemption.self.assign(9, 0);
  for (const int v : {0, 1, 4}) exemption.self[v] = 1;
  CHECK_FALSE(exemption.leaves_alone(world, {0, 1, 4, 5}));  // 5 is clean of the rest
  exemption.self[5] = 1;
  CHECK(exemption.leaves_alone(world, {0, 1, 4, 5}));
  CHECK_FALSE(exemption.leaves_alone(world, {0, 1, 2, 5}));
  CHECK_FALSE(exemption.leaves_alone(world, {4, 9, 10, 11}));
  exemption.body.assign(9, 0);
  exemption.body[4] = 1;
  CHECK(exemption.leaves_alone(world, {4, 9, 10, 11}));
  exemption.switched_off.assign(world.node_count, 0);
  exemption.switched_off[9] = exemption.switched_off[10] = 1;
  CHECK_FALSE(exemption.leaves_alone(world, {0, 9, 10, 11}));
  exemption.switched_off[11] = 1;
  CHECK_FALSE(exemption.leaves_alone(world, {0, 9, 10, 11}));  // it comes from outside
  exemption.switched_off[0] = 1;                               // it is caught
  CHECK(exemption.leaves_alone(world, {0, 9, 10, 11}));
  CHECK_FALSE(exemption.leaves_alone(world, {0, 9, 10, 12}));
}

TEST_CASE("recovery: a body that jumps farther than its size is not swept along, and what it lands on gets clean",
          "[recovery]") {
  World w = make_world(sheet(12, 0.4, 0));
  add_obstacle(w, block({3, 0, 0}, 0.03));
  w.drive.acceleration.setZero();
  const Points there = block({0.01, 0, 0.02}, 0.03).x;
  const auto stepper = make_recovering_conventional_stepper(w.scene, {});
  State state = w.state, to;
  w.drive.obstacles = {there};
  StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.collision.jumped == 1);
  CHECK(to.obstacles[0] == there);
  CHECK((to.x - state.x).rowwise().norm().maxCoeff() < 0.1);  // a sweep at 90 m/s would carry it off
  for (int frame = 0; frame < 20; ++frame) {
    state = to;
    report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
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
  const StepReport report =
      testing::frame(w.scene, *make_recovering_conventional_stepper(w.scene, {}), w.state, w.drive, 1.0 / 30, to);
  REQUIRE(report.status == StepStatus::accepted);
  CHECK(report.collision.jumped == 0);
  CHECK(to.clean);
  CHECK(to.x.col(1).maxCoeff() > 1);
}

}  // namespace selvedge::test_recovery
