#include <catch2/catch.hpp>

#include <cmath>

#include "collision/search/intersections.hpp"
#include "learned/graph/integration.hpp"
#include "pipeline/training/hung_sheet.hpp"
#include "pipeline/training/training_watch.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

// What the contours' loss alone teaches. A sheet hangs from its upper edge, and one of its lower corners is folded up
// and through it. Its contour is short and closed by two boundaries, so that shortening it takes the corner out.

namespace selvedge::test_contour_folds {

namespace {

constexpr int frames = 20;  // of the roll-out that is judged

struct Lesson {
  const char* name;
  double weight;       // of the contours' loss [N/m]
  double shown;        // FeatureOptions::contour_force [N/m]
  int steps;           // of training; 0: the weights of stage 2 as they are
  bool fixed = false;  // it trains and is measured on the same four folds
};

TrainingOptions lesson_options(const Lesson& lesson) {
  TrainingOptions options = fake::tiny_training();
  options.architecture = "small_contour";
  options.weights = (config_folder() / "weights" / "only_repulsive.h5").string();
  options.steps = std::max(lesson.steps, 1);
  options.samples.edge = 0.035;
  options.samples.noise = 0;
  options.contact = {true, true, true};
  options.contour_force = lesson.shown;
  options.pool.states = 4;
  options.pool.passes = 2;
  options.objective.repulsion.weight = {2e6, 2e6};
  options.objective.contours.weight = {lesson.weight, lesson.weight};
  options.optimiser.learning_rate = 7e-4;
  return options;
}

Roll hung_roll(Trainer& trainer) {
  RollRequest request;
  request.sheet = HungStart::flat;
  request.still = false;
  request.with_body = false;
  request.cloth_contact = true;
  request.frames = frames + 1;
  Roll roll;
  trainer.queue->locked([&] { roll = make_roll(*trainer.maker, request); });
  return roll;
}

int crossings_of(const Roll& roll, const Points& x) {
  IntersectionCache cache;
  return static_cast<int>(intersecting_pairs(roll.scene->scene.surface, x, cache).size());
}

double left_of(Trainer& trainer, const std::vector<Points>& starts, const char* name) {
  const FrameMaking making = frame_making(trainer);
  std::array<double, frames + 1> pairs{};
  for (const Points& start : starts) {
    Roll roll = hung_roll(trainer);
    roll.start = start;
    RollingState state;
    begin_roll(std::move(roll), state);
    state.now.velocity.setZero();
    state.now.previous = state.now.x;
    pairs[0] += crossings_of(state.roll, state.now.x);
    for (int frame = 1; frame <= frames && !state.over; ++frame) {
      for (int pass = 0; pass < making.passes; ++pass) {
        NextCloth next;
        REQUIRE(predict(trainer, making, state, next));
        take_pass(making, next, HUGE_VAL, state);
      }
      pairs[static_cast<std::size_t>(frame)] += crossings_of(state.roll, state.now.x);
    }
  }
  WARN(name << ": pairs at 0, 1, 2, 5, 10, 20: " << pairs[0] << " " << pairs[1] << " " << pairs[2] << " " << pairs[5]
            << " " << pairs[10] << " " << pairs[20]);
  return pairs[frames] / pairs[0];
}

double left_after(const Lesson& lesson) {
  const auto trainer = make_trainer(lesson_options(lesson));
  const Points flat = hung_roll(*trainer).start;
  RandomStream random = stream_of(7, 1), unseen = stream_of(8, 1);
  std::vector<Points> judged;
  for (int k = 0; k < (lesson.fixed ? 4 : 16); ++k) judged.push_back(folded(flat, unseen));
  for (int step = 0; step < lesson.steps; ++step) {
    for (std::size_t k = 0; k < trainer->pool.size(); ++k) {
      if (step > 0 && !trainer->pool[k].over && trainer->pool[k].frame < 10) continue;
      Roll roll = hung_roll(*trainer);
      roll.start = lesson.fixed ? judged[k] : folded(flat, random);
      begin_roll(std::move(roll), trainer->pool[k]);
      trainer->pool[k].now.velocity.setZero();
      trainer->pool[k].now.previous = trainer->pool[k].now.x;
    }
    REQUIRE(train_step(*trainer).adam.taken);
  }
  return left_of(*trainer, judged, lesson.name);
}

}  // namespace

TEST_CASE("training: the contours' loss alone opens folds that the network has not seen", "[training][.long]") {
  const double as_it_is = left_after({"stage 2 as it is", 0, 0, 0});
  const double shown = left_after({"stage 2, shown the contours' gradient", 0, 30, 0});
  const double without = left_after({"no loss", 0, 0, 300});
  const double with = left_after({"loss 300", 300, 0, 300});
  const double same = left_after({"loss 300 on the same four", 300, 0, 300, true});
  WARN("left after 20 frames: " << as_it_is << ", shown " << shown << ", no loss " << without << ", loss " << with
                                << ", on the same four " << same);
  CHECK(with < 0.25 * without);
  CHECK(same < 0.25 * without);
  CHECK(shown < 0.25 * as_it_is);
}

}  // namespace selvedge::test_contour_folds
