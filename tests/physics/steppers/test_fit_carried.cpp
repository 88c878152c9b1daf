#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "physics/steppers/fit_carried.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_fit_carried {

namespace {

constexpr double dt = 1.0 / 30;
constexpr int side = 4, count = (side + 1) * (side + 1);  // quads along a side, vertices

// A worn sheet whose target turns and sways, with rows that no two terms share.
testing::World worn_sheet() {
  testing::World world = testing::make_world(testing::sheet(side, 0.2, 1));
  world.drive.acceleration = {0, -9.81, 0};
  return world;
}

Points wavy(double size, double phase) {
  Points rows(count, 3);
  for (int v = 0; v < count; ++v)
    for (int k = 0; k < 3; ++k) rows(v, k) = size * std::sin(1.7 * v + 2.3 * k + phase + 0.4 * v * std::sin(phase));
  return rows;
}

Points target_at(const testing::World& world, int frame) {
  const Mat3 turn = Eigen::AngleAxisd(0.1 * frame, Vec3(0.3, 0.5, 0.8).normalized()).toRotationMatrix();
  return (world.state.x * turn.transpose()) + wavy(0.01, frame);
}

// A state of frame `f` >= 2, with memory of two frames, and the drive to the next one.
State worn_state(testing::World& world, int f) {
  State before = world.state;
  for (int k = f - 2; k <= f; ++k) {
    State now = before;
    world.drive.skinned_targets = target_at(world, k);
    now.x = target_at(world, k) + wavy(0.02, 3.1 * k);
    now.memory = carried_memory(before, world.drive, now.x, 2);
    before = now;
  }
  world.drive.skinned_targets = target_at(world, f + 1);
  return before;
}

CarriedTerms terms_at(testing::World& world, const State& from) {
  return carried_terms(world.scene, from, world.drive, dt, all_carried_terms);
}

CarriedSet planted_set() {
  CarriedSet set;
  set << 0.9, 0.4, -0.2, 0.15, -0.1, 0.3, 0.25, 0.7;
  return set;
}

// What the coefficients make of the terms.
Points motion_of(const CarriedTerms& terms, const CarriedSet& set) {
  Points motion = Points::Zero(count, 3);
  for (int k = 0; k < carried_term_count; ++k) motion += set[k] * terms.rows[static_cast<std::size_t>(k)];
  return motion;
}

}  // namespace

TEST_CASE("fit of the carried guess: planted coefficients come out, for the scene and for a vertex", "[fit_carried]") {
  testing::World world = worn_sheet();
  CarriedSet own = planted_set();
  own[0] = 1.1;
  CarriedFit alike, two;
  for (int f = 2; f < 12; ++f) {
    const CarriedTerms terms = terms_at(world, worn_state(world, f));
    REQUIRE(add_frame(world.scene, terms, motion_of(terms, planted_set()), alike));
    Points motion = motion_of(terms, planted_set());
    motion.row(7) = motion_of(terms, own).row(7);
    REQUIRE(add_frame(world.scene, terms, motion, two));
  }
  CHECK((fitted_scene_set(alike) - planted_set()).cwiseAbs().maxCoeff() < 1e-5);
  CHECK(distance_left(alike, {fitted_scene_set(alike)}) < 1e-6);
  CHECK(distance_left(alike, {}) > 1e-3);
  const CarriedModel model = fitted_own_sets(two, 1e-6);
  CHECK((model.own.row(7).transpose() - own).cwiseAbs().maxCoeff() < 1e-3);
  CHECK((model.own.row(8).transpose() - planted_set()).cwiseAbs().maxCoeff() < 1e-3);
  CHECK(distance_left(two, model) < distance_left(two, {model.scene}));
  const CarriedModel held = fitted_own_sets(two, 1e6);  // the scene's set counts for more than all frames
  CHECK((held.own.row(7).transpose() - held.scene).norm() < 1e-3 * (own - held.scene).norm() + 1e-6);
}

TEST_CASE("fit of the carried guess: a vertex without frames has the scene's set, and so have pins", "[fit_carried]") {
  testing::World world = worn_sheet();
  world.scene.pins = {2};
  CarriedFit fit;
  for (int f = 2; f < 8; ++f) {
    const State from = worn_state(world, f);
    world.drive.skinned_targets.row(11).setConstant(std::numeric_limits<double>::quiet_NaN());
    const CarriedTerms terms = terms_at(world, from);
    Points motion = motion_of(terms, planted_set()) + wavy(1e-3, f);
    motion.row(13).setConstant(std::numeric_limits<double>::infinity());
    REQUIRE(add_frame(world.scene, terms, motion, fit));
  }
  const CarriedModel model = fitted_own_sets(fit, 5);
  for (const int v : {2, 11, 13}) CHECK(model.own.row(v) == model.scene.transpose());
  CHECK(model.own.row(12) != model.scene.transpose());
  CHECK(model.own.allFinite());
  CHECK(fitted_scene_set({}) == default_carried_set());
}

TEST_CASE("fit of the carried guess: terms that frames do not tell apart keep their coefficients", "[fit_carried]") {
  testing::World world = worn_sheet();
  world.drive.acceleration.setZero();
  CarriedFit fit;
  for (int f = 2; f < 8; ++f) {
    const CarriedTerms terms = terms_at(world, worn_state(world, f));
    add_frame(world.scene, terms, motion_of(terms, planted_set()), fit);
  }
  CHECK(fitted_scene_set(fit)[static_cast<int>(CarriedTerm::gravity)] == 0);
  CHECK(fitted_scene_set(fit)[static_cast<int>(CarriedTerm::turn)] == Approx(0.3).margin(1e-4));
}

TEST_CASE("fit of the carried guess: frames of which memory knows too little are left out", "[fit_carried]") {
  testing::World world = worn_sheet();
  CarriedFit fit;
  State from = world.state;
  world.drive.skinned_targets = target_at(world, 1);
  CHECK_FALSE(add_frame(world.scene, terms_at(world, from), Points::Zero(count, 3), fit));
  from.memory = carried_memory(world.state, world.drive, from.x, 2);  // of the first frame: there is none before it
  CHECK_FALSE(add_frame(world.scene, terms_at(world, from), Points::Zero(count, 3), fit));
  CHECK(fit.vertices.empty());
}

}  // namespace selvedge::test_fit_carried
