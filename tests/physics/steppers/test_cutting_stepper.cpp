#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/untangle/crossing_triangles.hpp"
#include "physics/frame/frame_audits.hpp"
#include "physics/recovery/cut_out.hpp"
#include "physics/steppers/cutting_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_cutting_stepper {

using testing::World;

namespace {

constexpr double dt = 1.0 / 30;
constexpr int quads = 10;

// A closed spike that stands in the sheet's middle and ends so far above it.
testing::Sheet spike(double above) {
  testing::Sheet s{Points(4, 3), Triangles(4, 3)};
  s.x << 0.003, above, 0.001, -0.12, above - 0.3, -0.1, 0.13, above - 0.3, -0.09, 0.01, above - 0.3, 0.14;
  s.triangles << 0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3;
  return s;
}

// A band without a top and a bottom through the sheet, round its middle.
testing::Sheet band(double height) {
  constexpr int n = 16;
  testing::Sheet s{Points(2 * n, 3), Triangles(2 * n, 3)};
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.3) / n, r = 0.093;
    s.x.row(k) << r * std::cos(angle), height - 0.05, r * std::sin(angle);
    s.x.row(n + k) << r * std::cos(angle), height + 0.05, r * std::sin(angle);
    const int next = (k + 1) % n;
    s.triangles.row(2 * k) << k, next, n + k;
    s.triangles.row(2 * k + 1) << next, n + next, n + k;
  }
  return s;
}

// A sheet, held at its boundary, with something through its middle; what is cut out of it stays at its targets.
World pierced(const testing::Sheet& sheet, const testing::Sheet& by, bool held = true) {
  World w = make_world(sheet);
  add_obstacle(w, by);
  w.scene.obstacles[0].moving = true;
  if (held)
    for (int v = 0; v < sheet.x.rows(); ++v)
      if (sheet.x.row(v).cwiseAbs().maxCoeff() > 0.199) w.scene.pins.push_back(v);
  w.drive.pins = sheet.x(w.scene.pins, Eigen::all);
  w.drive.acceleration.setZero();
  w.drive.skinned_targets = sheet.x;
  return w;
}

std::vector<char> all(const World& w) { return std::vector<char>(w.scene.rest_triangle.size(), 1); }

std::unique_ptr<Stepper> cutting(const Scene& scene) {
  return make_cutting_stepper(scene, testing::conventional, testing::conventional(scene));
}

std::vector<int> crossing_now(const World& w, const State& state) {
  const ContactWorld world = make_contact_world(w.scene.surface, obstacle_surfaces(w.scene), true);
  const std::vector<char> marks = crossing_triangles(world, gather_nodes(state.x, state.obstacles));
  std::vector<int> found;
  for (std::size_t t = 0; t < marks.size(); ++t)
    if (marks[t]) found.push_back(static_cast<int>(t));
  return found;
}

const testing::Sheet cloth = testing::sheet(quads, 0.4, 0);
constexpr int middle = (quads + 1) * (quads + 1) / 2;

// The spike goes down 2 cm a frame. Returns the states, the first one at the start.
std::vector<State> lowered(World w, int frames, int renew = 1 << 30) {
  w.state.cut_out = cut_out_at_start(w.scene, w.state, all(w));
  std::vector<State> states{w.state};
  auto stepper = cutting(w.scene);
  for (int f = 1; f <= frames; ++f) {
    if (f % renew == 0) stepper = cutting(w.scene);
    w.drive.obstacles[0] = spike(0.1 - 0.02 * f).x;
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, states.back(), w.drive, dt, to);
    REQUIRE(report.status == StepStatus::accepted);
    REQUIRE(report.audit);
    CHECK(report.audit->intersecting_pairs() == 0);
    CHECK(report.audit->inside_vertices == 0);
    CHECK(report.collision.pairs_after + report.collision.passed_through + report.collision.left_alone == 0);
    CHECK(report.collision.cut_out == static_cast<int>(to.cut_out.size()));
    CHECK(to.clean);
    states.push_back(to);
  }
  return states;
}

}  // namespace

TEST_CASE("cutting stepper: what is cut out comes back when it is free, and the rest is clean throughout",
          "[cutting]") {
  const World w = pierced(cloth, spike(0.1));
  const std::vector<State> states = lowered(w, 8);
  CHECK(states[0].cut_out.size() > 6);
  CHECK(states[0].cut_out == crossing_now(w, states[0]));
  for (std::size_t f = 0; f < states.size(); ++f) {
    INFO(f);
    const State& state = states[f];
    const Audit uncut = audit_uncut(w.scene, state);
    CHECK(uncut.intersecting_pairs() + uncut.inside_vertices == 0);
    CHECK(state.cut_out == crossing_now(w, state));  // none that is free stays, none that is not comes back
    if (f > 0) CHECK(std::ranges::includes(states[f - 1].cut_out, state.cut_out));
  }
  CHECK(audit_positions(w.scene, states[1].x, states[1].obstacles).intersecting_pairs() > 0);
  CHECK(states.back().cut_out.empty());
  CHECK((states.back().x - cloth.x).rowwise().norm().maxCoeff() < 0.03);
}

TEST_CASE("cutting stepper: vertices that only cut triangles have go to their targets, pins where they are held",
          "[cutting]") {
  World w = pierced(cloth, spike(0.25));
  w.scene.pins.insert(std::ranges::lower_bound(w.scene.pins, middle), middle);
  w.state.cut_out = cut_out_at_start(w.scene, w.state, all(w));
  w.drive.pins = cloth.x(w.scene.pins, Eigen::all);
  w.drive.skinned_targets = cloth.x.rowwise() + Eigen::RowVector3d(0, 0.004, 0);
  State to;
  REQUIRE(testing::frame(w.scene, *cutting(w.scene), w.state, w.drive, dt, to).status == StepStatus::accepted);
  int followed = 0;
  for (int v = 0; v < cloth.x.rows(); ++v) {
    const auto round = w.scene.surface.triangles_of(v);
    const bool cut = std::ranges::all_of(round, [&](int t) { return std::ranges::count(w.state.cut_out, t) > 0; });
    if (v == middle) {
      CHECK((cut && to.x.row(v) == cloth.x.row(v)));
    } else if (cut) {
      ++followed;
      CHECK(to.x.row(v) == w.drive.skinned_targets.row(v));
      CHECK(to.v(v, 1) == Approx(0.004 / dt));
    } else {
      CHECK(to.x(v, 1) < 0.002);
    }
  }
  CHECK(followed > 0);
}

TEST_CASE("cutting stepper: a part that nothing holds is cut out with what it hung on, and comes back with it",
          "[cutting]") {
  World w = pierced(cloth, band(0), false);
  const std::vector<int> crossing = crossing_now(w, w.state);
  const auto has = [&](const std::vector<int>& list, int vertex) {
    return std::ranges::count(list, w.scene.surface.triangles_of(vertex)[0]) > 0;
  };
  const std::vector<int> cut = cut_out_at_start(w.scene, w.state, all(w));
  CHECK_FALSE(has(crossing, middle));
  CHECK(has(cut, middle));
  CHECK(cut.size() > crossing.size());
  CHECK(std::ranges::includes(cut, crossing));
  CHECK_FALSE(has(cut, 0));

  World pinned = w;
  pinned.scene.pins = {middle};
  CHECK(cut_out_at_start(pinned.scene, w.state, all(w)) == crossing);
  World buttoned = w;
  buttoned.scene.springs = {{middle, 0, 0.1}};
  CHECK(cut_out_at_start(buttoned.scene, w.state, all(w)) == crossing);
  // A piece of its own, which has nothing to be connected with.
  testing::Sheet far = testing::sheet(2, 0.1, 0);
  far.x.rowwise() += Eigen::RowVector3d(1, 0, 0);
  const World two = pierced(testing::join(cloth, far), band(0), false);
  CHECK(cut_out_at_start(two.scene, two.state, all(two)) == cut);
  // What may not be cut stays.
  CHECK(cut_out_at_start(w.scene, w.state, std::vector<char>(all(w).size(), 0)).empty());

  w.state.cut_out = cut;
  w.drive.obstacles[0] = band(-0.02).x;
  const auto stepper = cutting(w.scene);
  State to, later;
  REQUIRE(testing::frame(w.scene, *stepper, w.state, w.drive, dt, to).status == StepStatus::accepted);
  CHECK(to.cut_out == cut);
  w.drive.obstacles[0] = band(-0.1).x;
  REQUIRE(testing::frame(w.scene, *stepper, to, w.drive, dt, later).status == StepStatus::accepted);
  CHECK(later.cut_out.empty());
}

TEST_CASE("cutting stepper: all may be cut out, and nothing", "[cutting]") {
  World w = pierced(testing::sheet(1, 0.2, 0), spike(0.1), false);
  w.state.cut_out = cut_out_at_start(w.scene, w.state, all(w));
  REQUIRE(w.state.cut_out == std::vector<int>{0, 1});
  w.drive.skinned_targets.col(0).array() += 0.01;
  State to;
  REQUIRE(testing::frame(w.scene, *cutting(w.scene), w.state, w.drive, dt, to).status == StepStatus::accepted);
  CHECK(to.x == w.drive.skinned_targets);
  CHECK(to.frame == 1);
  CHECK(to.time == Approx(dt));
  CHECK(to.cut_out == w.state.cut_out);

  World free = pierced(cloth, spike(-0.2));
  free.drive.acceleration = {0, -9.81, 0};
  State one, other;
  REQUIRE(testing::frame(free.scene, *cutting(free.scene), free.state, free.drive, dt, one).status ==
          StepStatus::accepted);
  REQUIRE(testing::frame(free.scene, *testing::conventional(free.scene), free.state, free.drive, dt, other).status ==
          StepStatus::accepted);
  CHECK(one.x == other.x);
}

TEST_CASE("cutting stepper: the same bits in two threads as in one, and from any state on", "[cutting][threads]") {
  const World w = pierced(cloth, spike(0.1));
  std::vector<State> runs[3];
  for (int k = 0; k < 2; ++k) with_threads(k + 1, [&] { runs[k] = lowered(w, 6); });
  runs[2] = lowered(w, 6, 2);
  for (int k = 1; k < 3; ++k) {
    CHECK(same_bits(runs[k].back().x, runs[0].back().x));
    CHECK(runs[k][3].cut_out == runs[0][3].cut_out);
  }
}

}  // namespace selvedge::test_cutting_stepper
