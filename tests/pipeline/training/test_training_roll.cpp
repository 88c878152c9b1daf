#include <catch2/catch.hpp>

#include <set>

#include "learned/network/architecture.hpp"
#include "learned/steppers/learned_state.hpp"
#include "pipeline/motions/clip_split.hpp"
#include "pipeline/obstacles/setup_paths.hpp"
#include "pipeline/training/roll_queue.hpp"
#include "pipeline/training/rolling_state.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

namespace selvedge::test_training_roll {

namespace {

double area_of(const Surface& surface, const Points& x) {
  double sum = 0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    sum += (row(x, surface.triangles(t, 1)) - row(x, surface.triangles(t, 0)))
               .cross(row(x, surface.triangles(t, 2)) - row(x, surface.triangles(t, 0)))
               .norm();
  return sum;
}

// Six times the volume that the surface encloses.
double volume_of(const Surface& surface, const Points& x) {
  double sum = 0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    sum += row(x, surface.triangles(t, 0)).dot(row(x, surface.triangles(t, 1)).cross(row(x, surface.triangles(t, 2))));
  return sum;
}

}  // namespace

TEST_CASE("training rolls: which they are depends on seed and number alone, and grows with the run", "[training]") {
  const TrainingOptions options = fake::tiny_training();
  const RollMaker& maker = fake::tiny_maker();
  std::set<int> firsts;
  int most_early = 0, most_late = 0, still = 0, mirrored = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    const RollRequest early = draw_roll(options, maker.world, k, 0), late = draw_roll(options, maker.world, k, 1);
    CHECK(early == draw_roll(options, maker.world, k, 0));
    CHECK(late.first_frame + late.frames < frame_count(maker.world, late.body, late.clip));
    most_early = std::max(most_early, early.frames);
    most_late = std::max(most_late, late.frames);
    firsts.insert(late.first_frame);
    still += late.still;
    mirrored += late.mirrored;
  }
  CHECK(most_early == 2);
  CHECK(most_late == 6);
  CHECK(firsts.size() > 80);
  CHECK(std::abs(still - 150) < 40);
  CHECK(std::abs(mirrored - 150) < 40);
  TrainingOptions other = options;
  other.seed = 2;
  CHECK_FALSE(draw_roll(other, maker.world, 0, 1) == draw_roll(options, maker.world, 0, 1));
}

TEST_CASE("training rolls: no clip or garment of the validation split is in a world", "[training]") {
  SampleOptions samples;
  std::set<std::string> validation;
  for (const ClipEntry& entry : read_clip_split(config_folder() / "clips.yaml"))
    if (entry.validation) validation.insert(entry.name);
  REQUIRE(validation.size() == 8);
  samples.soft_tissue = false;
  samples.edge = 0.045;
  const TrainingWorld world = make_training_world(samples, 1);
  REQUIRE(world.bodies.size() == 1);
  CHECK(world.bodies[0].clips.size() == 30);
  for (const TrainingClip& clip : world.bodies[0].clips) CHECK_FALSE(validation.contains(clip.name));
}

TEST_CASE("training rolls: turned and mirrored they are the same garment on the same body", "[training]") {
  RollMaker& maker = fake::tiny_maker();
  RollRequest plain;
  plain.first_frame = 20;
  plain.frames = 2;
  RollRequest turned = plain;
  turned.yaw = 1;
  turned.mirrored = true;
  const Roll a = make_roll(maker, plain), b = make_roll(maker, turned);
  REQUIRE(a.body.size() == 4);
  REQUIRE(a.cloth.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    const Points cloth_a = a.cloth[k].cast<double>(), cloth_b = b.cloth[k].cast<double>();
    CHECK(area_of(b.scene->scene.surface, cloth_b) == Approx(area_of(a.scene->scene.surface, cloth_a)).epsilon(1e-5));
    const Points body_a = a.body[k].cast<double>(), body_b = b.body[k].cast<double>();
    const double volume = volume_of(a.scene->graph.body, body_a);
    CHECK(volume > 0.1);  // triangles look outward, in the mirror too
    CHECK(volume_of(b.scene->graph.body, body_b) == Approx(volume).epsilon(1e-4));
  }
  CHECK(a.cloth[1] != a.cloth[2]);
  CHECK((a.start - a.cloth[1].cast<double>()).rowwise().norm().mean() > 1e-3);  // noise
  const Roll again = make_roll(maker, turned);
  CHECK(again.start == b.start);
}

TEST_CASE("training rolls: a queue prepares what it was asked for, in that order", "[training]") {
  RollMaker maker = fake::tiny_maker();
  RollQueue queue(maker);
  for (std::uint64_t k = 0; k < 4; ++k) queue.ask(draw_roll(maker.options, maker.world, k, 0));
  CHECK(queue.take().request.number == 0);
  CHECK(queue.take().request.number == 1);
  const std::vector<RollRequest> waiting = queue.waiting();
  REQUIRE(waiting.size() == 2);
  CHECK(waiting[0].number == 2);
  CHECK(waiting[1] == draw_roll(maker.options, maker.world, 3, 0));
}

TEST_CASE("rolling states: bodies stand still while cloth settles, then move as the clip does", "[training]") {
  RollMaker& maker = fake::tiny_maker();
  const FrameMaking making = fake::tiny_making();
  for (const bool still : {true, false}) {
    INFO(still);
    RollRequest request;
    request.first_frame = 30;
    request.frames = 3;
    request.still = still;
    RollingState state;
    begin_roll(make_roll(maker, request), state);
    const Roll& roll = state.roll;
    const auto body = [&](int k) { return Points(roll.body[static_cast<std::size_t>(k)].cast<double>()); };
    CHECK(state.now.timestep == (still ? settling_time : learned_dt));
    CHECK(state.now.body == body(1));
    CHECK(state.now.body_target == (still ? body(1) : body(2)));
    if (still) CHECK(state.now.velocity.isZero(0));
    NextCloth next{state.now.x, Points::Constant(state.now.x.rows(), 3, 1e-3)};
    take_pass(making, next, 1, state);
    CHECK(state.pass == 1);
    CHECK(state.frame == 0);
    CHECK(state.now.guess == next.x);
    take_pass(making, next, 1, state);
    REQUIRE(state.frame == 1);
    CHECK(state.now.guess.rows() == 0);
    CHECK(state.now.timestep == learned_dt);
    CHECK(state.now.velocity.isZero(0) == still);
    CHECK(state.now.body == (still ? body(1) : body(2)));
    CHECK(state.now.body_previous == body(1));
    CHECK(state.now.body_target == (still ? body(2) : body(3)));
    for (int pass = 0; pass < 4; ++pass) take_pass(making, next, 1, state);
    CHECK(state.over);
  }
}

TEST_CASE("rolling states: a roll-out that leaves the garment as worn is over", "[training]") {
  RollMaker& maker = fake::tiny_maker();
  FrameMaking making = fake::tiny_making();
  making.passes = 1;
  RollRequest request;
  request.first_frame = 30;
  request.frames = 3;
  RollingState state;
  begin_roll(make_roll(maker, request), state);
  NextCloth next{state.now.x, Points::Zero(state.now.x.rows(), 3)};
  take_pass(making, next, 0.6, state);
  CHECK_FALSE(state.over);
  next.x(5, 1) += 0.7;
  take_pass(making, next, 0.6, state);
  CHECK(state.over);
}

// The frames of a roll-out in which the cloth follows its skinned target exactly, so that nothing is left of its
// motion.
TEST_CASE("training rolls: beside the carried guess a frame begins where the skinned target takes the cloth",
          "[training][student]") {
  RollMaker maker = fake::tiny_maker();
  maker.scenes.clear();
  FrameMaking making = fake::tiny_making();
  making.features = maker.features = architecture_preset("student").features;
  making.passes = 1;
  RollRequest request;
  request.first_frame = 40;
  request.frames = 3;
  for (const bool still : {false, true}) {
    request.still = still;
    RollingState state;
    begin_roll(make_roll(maker, request), state);
    const auto target = [&](int entry) -> Points {
      return state.roll.cloth[static_cast<std::size_t>(entry)].cast<double>();
    };
    const std::size_t free = [&] {
      std::size_t v = 0;
      while (state.roll.scene->graph.types[v] == pinned_vertex) ++v;
      return v;
    }();
    const auto row_of = [&](const Points& x) { return Vec3(row(x, static_cast<int>(free))); };
    for (int entry = 1; !state.over; ++entry) {
      INFO("still " << still << ", entry " << entry);
      const bool settling = is_settling(state);
      if (settling) --entry;
      const Vec3 way = settling ? Vec3(Vec3::Zero()) : Vec3(row_of(target(entry + 1)) - row_of(target(entry)));
      CHECK((row_of(state.now.guess) - row_of(state.now.x) - way).norm() < 1e-7);
      CHECK(state.now.frames.size() == static_cast<std::size_t>(state.now.x.rows()));
      Graph graph;
      REQUIRE(raw_graph_of(making, {}, state, graph));
      CHECK(state.now.elastic.allFinite());
      CHECK(state.now.elastic.norm() > 0);
      NextCloth next{state.now.guess, state.now.guess - state.now.x};
      take_pass(making, next, 10, state);
    }
  }
}

}  // namespace selvedge::test_training_roll
