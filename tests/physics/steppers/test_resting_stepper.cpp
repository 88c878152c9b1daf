#include <catch2/catch.hpp>

#include "physics/energies/measures.hpp"
#include "physics/scene/part_of_scene.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "physics/steppers/resting_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_resting_stepper {

using testing::Run;
using testing::World;

namespace {

testing::Sheet moved(testing::Sheet sheet, const Vec3& by) {
  sheet.x.rowwise() += by.transpose();
  return sheet;
}

// Two cloths: `first` over a plate, `second` anywhere.
World two_cloths(const testing::Sheet& first, const testing::Sheet& second) {
  World w = make_world(testing::join(first, second));
  const int vertices = static_cast<int>(first.x.rows()), triangles = static_cast<int>(first.triangles.rows());
  Cloth one = w.scene.cloths[0], other = one;
  other.first_vertex = vertices;
  other.vertex_count -= vertices;
  other.first_triangle = triangles;
  other.triangle_count -= triangles;
  one.vertex_count = vertices;
  one.triangle_count = triangles;
  w.scene.cloths = {one, other};
  add_obstacle(w, testing::sheet(4, 0.4, 0));
  return w;
}

const testing::Sheet lying = testing::sheet(5, 0.1, 2e-3);

// A sheet on the plate; the other hangs far off by its first vertex and swings.
World one_swings() {
  World w = two_cloths(lying, moved(testing::sheet(6, 0.3, 0), {2, 1, 0}));
  w.scene.pins = {static_cast<int>(lying.x.rows())};
  w.drive.pins = w.state.x.row(w.scene.pins[0]);
  return w;
}

std::unique_ptr<Stepper> resting(const Scene& scene) {
  return make_resting_stepper(scene, testing::conventional, testing::conventional(scene));
}

// Steps until `enough` cloths rest.
State until_resting(const World& w, int enough) {
  const auto stepper = resting(w.scene);
  State state = w.state, to;
  for (int f = 0; f < 300; ++f) {
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    if (report.resting >= enough) return to;
    state = to;
  }
  FAIL("never rests");
  return state;
}

int resting_next(const World& w, const State& from) {
  State to;
  return testing::frame(w.scene, *resting(w.scene), from, w.drive, 1.0 / 30, to).resting;
}

}  // namespace

TEST_CASE("resting stepper: part of a scene is the scene without the others", "[resting]") {
  World w = one_swings();
  w.scene.cloths[1].material.density = 0.4;
  const World alone = make_world(moved(testing::sheet(6, 0.3, 0), {2, 1, 0}));
  const PartOfScene part = part_of(w.scene, std::vector<char>{0, 1});
  CHECK(part.scene.surface.triangles == alone.scene.surface.triangles);
  CHECK(part.scene.rest == alone.scene.rest);
  CHECK(part.scene.pins == std::vector<int>{0});
  CHECK(part.scene.obstacles.size() == 1);
  CHECK(lumped_masses(part.scene).sum() == Approx(0.4 * 0.09));
  w.state.x.setRandom();
  w.state.v.setRandom();
  const LastClean clean{2 * w.state.x, {3 * w.state.obstacles[0]}};
  remember(clean, w.state);
  const State of_part = state_of(part, w.state);
  CHECK(of_part.x == w.state.x.bottomRows(49));
  CHECK(last_clean(of_part).x == clean.x.bottomRows(49));
  CHECK(last_clean(of_part).obstacles == clean.obstacles);
  CHECK(drive_of(part, w.drive).pins == w.drive.pins);
  State back = w.state;
  back.x.bottomRows(49).setZero();
  back.v.bottomRows(49).setZero();
  back.memory.clear();
  put(part, of_part, back);
  CHECK(back.x == w.state.x);
  CHECK(back.v == w.state.v);
  CHECK(last_clean(back).x.topRows(36) == w.state.x.topRows(36));  // what is left out has not moved
  CHECK(last_clean(back).x.bottomRows(49) == clean.x.bottomRows(49));
  CHECK(last_clean(back).obstacles == clean.obstacles);
  State without = of_part;
  without.memory.clear();
  put(part, without, back);
  CHECK(last_clean(back).x.rows() == 0);
  const Audit audit = whole_audit(part, Audit{{{0, 3}}, {{1, 2}}, {{4, 5}}, 0, 0});
  CHECK(audit.self_pairs[0] == std::pair(50, 53));
  CHECK(audit.vertex_pairs[0] == std::pair(51, 52));
  CHECK(audit.obstacle_pairs[0] == std::pair(54, 5));
}

TEST_CASE("resting stepper: what rests stays and costs no work, what moves does as if alone", "[resting]") {
  const World w = one_swings();
  const State calm = until_resting(w, 1);
  const auto stepper = resting(w.scene);
  World alone = make_world(moved(testing::sheet(6, 0.3, 0), {2, 1, 0}));
  alone.scene.pins = {0};
  add_obstacle(alone, testing::sheet(4, 0.4, 0));
  const PartOfScene part = part_of(w.scene, std::vector<char>{0, 1});
  State state = calm, to, expected = state_of(part, calm), next;
  alone.drive.pins = w.drive.pins;
  const auto other = testing::conventional(alone.scene);
  for (int f = 0; f < 20; ++f) {
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    const StepReport of_other = testing::frame(alone.scene, *other, expected, alone.drive, 1.0 / 30, next);
    CHECK(report.resting == 1);
    CHECK(report.iterations == of_other.iterations);
    REQUIRE(report.audit);
    CHECK(report.audit->intersecting_pairs() == 0);
    CHECK(to.x.topRows(36) == calm.x.topRows(36));
    CHECK(to.x.bottomRows(49) == next.x);
    CHECK(to.time == Approx(state.time + 1.0 / 30));
    CHECK(to.frame == state.frame + 1);
    state = to;
    expected = next;
  }
}

TEST_CASE("resting stepper: where all rest nothing is solved", "[resting]") {
  const World w = two_cloths(lying, moved(lying, {0.12, 0, 0}));
  const State calm = until_resting(w, 2);
  State to;
  const StepReport report = testing::frame(w.scene, *resting(w.scene), calm, w.drive, 1.0 / 30, to);
  CHECK(report.resting == 2);
  CHECK(report.iterations == 0);
  CHECK(report.counts.audits == 1);  // as in every frame
  CHECK(report.status == StepStatus::accepted);
  CHECK(to.x == calm.x);
  CHECK(to.v.isZero(0));
  CHECK(to.clean);
}

TEST_CASE("resting stepper: cloths that a spring joins rest together or move together", "[resting]") {
  World still = two_cloths(lying, moved(lying, {0.12, 0, 0}));
  still.scene.springs = {{5, 36, 0.02, 100}};
  CHECK(resting_next(still, until_resting(still, 2)) == 2);

  World w = one_swings();
  w.scene.springs = {{5, 36, (w.state.x.row(5) - w.state.x.row(36)).norm(), 1e-6}};
  const auto stepper = resting(w.scene);
  State state = w.state, to;
  for (int f = 0; f < 40; ++f) {
    CHECK(testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to).resting == 0);
    state = to;
  }
  CHECK(rest_of(state).seconds[0] > 0.5);  // it would rest alone
  w.scene.springs.clear();
  CHECK(resting_next(w, state) == 1);

  World woken = still;  // what comes near the one wakes the other
  State calm = until_resting(still, 2);
  add_obstacle(woken, moved(testing::sheet(2, 0.02, 0), {0.15, 0.02, 0}));
  calm.obstacles.push_back(woken.drive.obstacles[1]);
  woken.drive.obstacles[1].col(1).array() -= 0.01;
  CHECK(resting_next(woken, calm) == 0);
  woken.scene.springs.clear();
  CHECK(resting_next(woken, calm) == 1);
}

TEST_CASE("resting stepper: a part of a scene keeps its springs, in its own numbers", "[resting]") {
  World w = two_cloths(lying, moved(lying, {0.12, 0, 0}));
  w.scene.springs = {{40, 50, 0.1, 7}, {1, 2, 0.2, 8}};
  const std::vector<Spring> first = part_of(w.scene, std::vector<char>{1, 0}).scene.springs;
  const std::vector<Spring> second = part_of(w.scene, std::vector<char>{0, 1}).scene.springs;
  REQUIRE((first.size() == 1 && second.size() == 1));
  CHECK((first[0].a == 1 && first[0].b == 2 && first[0].rest_length == 0.2 && first[0].stiffness == 8));
  CHECK((second[0].a == 4 && second[0].b == 14 && second[0].rest_length == 0.1 && second[0].stiffness == 7));
  CHECK(part_of(w.scene, std::vector<char>{1, 1}).scene.springs.size() == 2);
}

TEST_CASE("resting stepper: a start at zero speed does not rest, and caches carry no state", "[resting]") {
  const World w = one_swings();
  CHECK(resting_next(w, w.state) == 0);
  const Run kept = run(w, 60, 1 << 30, resting), dropped = run(w, 60, 3, resting);
  CHECK(kept.state.x == dropped.state.x);
  CHECK(kept.state.v == dropped.state.v);
  CHECK(kept.pairs == 0);
}

TEST_CASE("resting stepper: what comes near, pins, wind and gravity wake a cloth", "[resting]") {
  World w = one_swings();
  const State calm = until_resting(w, 1);
  REQUIRE(resting_next(w, calm) == 1);

  World windy = w;
  windy.scene.wind.on = true;
  windy.drive.wind = {1, 0, 0};
  CHECK(resting_next(windy, calm) == 0);
  World lighter = w;
  lighter.drive.acceleration *= 0.5;
  CHECK(resting_next(lighter, calm) == 0);

  World lifted = w;  // the plate it lies on moves
  lifted.drive.obstacles[0].col(1).array() += 1e-3;
  CHECK(resting_next(lifted, calm) == 0);
  World aside = w;  // an obstacle far from it moves
  add_obstacle(aside, moved(testing::sheet(2, 0.1, 0), {0, 0, 3}));
  State beside = calm;
  beside.obstacles.push_back(aside.drive.obstacles[1]);
  aside.drive.obstacles[1].col(0).array() += 0.1;
  CHECK(resting_next(aside, beside) == 1);

  State flying = calm;  // the other cloth comes over it in this step
  for (int i = 36; i < 85; ++i) flying.x.row(i) -= Eigen::RowVector3d(2, 0.5, 0);
  World free = w;
  free.scene.pins.clear();
  free.drive.pins = Points(0, 3);
  flying.v.setZero();
  CHECK(resting_next(free, flying) == 1);
  flying.v.bottomRows(49).col(1).setConstant(-20);
  CHECK(resting_next(free, flying) == 0);

  State tangled = calm;
  tangled.clean = false;
  CHECK(resting_next(w, tangled) == 0);
}

TEST_CASE("resting stepper: a sheet that falls on a resting one wakes it and both end clean and at rest", "[resting]") {
  World w = two_cloths(lying, moved(testing::sheet(5, 0.1, 0), {0.02, 0.4, 0.01}));
  State state = w.state, to;
  remember(Rest{{10, 0}, w.state.x, Vec3::Zero(), w.drive.acceleration}, w.state);
  state = w.state;
  state.clean = true;
  const auto stepper = resting(w.scene);
  int alone = 0, together = 0, at_rest = 0;
  for (int f = 0; f < 200; ++f) {
    const StepReport report = testing::frame(w.scene, *stepper, state, w.drive, 1.0 / 30, to);
    REQUIRE(report.status == StepStatus::accepted);
    CHECK(report.collision.pairs_after == 0);
    CHECK(report.collision.passed_through == 0);
    alone += report.resting == 1;
    together += report.resting == 0;
    at_rest += report.resting == 2;
    state = to;
  }
  CHECK(alone > 3);
  CHECK(together > 20);
  CHECK(at_rest > 0);
  CHECK(state.x.bottomRows(36).col(1).minCoeff() > 0);
}

}  // namespace selvedge::test_resting_stepper
