#include <catch2/catch.hpp>

#include "learned/graph/integration.hpp"
#include "learned/losses/volume_loss.hpp"
#include "pipeline/training/training_watch.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

// Trains a network on four fixed tangles of a T-shirt for 200 steps, with the volume loss and without. The body's
// collision and stretching alone would remove three quarters of a clip's volume in one frame. So the tangles are at
// rest under all losses except that of the volume, over a body at rest.

namespace selvedge::test_senc_tangles {

namespace {

constexpr double least_volume = 2e-6,
                 most_volume = 1e-4;  // of a tangle at rest [m^3]; with more an arm is in the trunk
constexpr int frames_to_rest = 20;
constexpr double moves_at_rest = 4e-3;  // of no vertex more in the last of them [m]

TrainingOptions tangle_training(double weight) {
  TrainingOptions options = fake::tiny_training();
  options.architecture = "small_senc";
  options.width = 32;
  options.message_steps = 3;
  options.steps = 200;
  options.pool.states = 4;
  options.pool.passes = 1;
  options.samples.noise = 0;
  options.samples.mirror = options.samples.yaw = false;
  options.samples.clips = {"arms_folded", "arms_up_down", "hands_through_torso"};
  options.objective.volume.weight = {weight, weight};
  return options;
}

double volume_at(const Roll& roll, const Points& x) {
  VolumeCounts counts;
  volume_loss(roll.scene->losses.closed, VolumeLoss{}, x, nullptr, &counts);
  return counts.volume;
}

// The roll-out stands still in its first frame, where the cloth goes on without the volume's loss until it rests, each
// frame from zero velocity. False: it moves on.
bool come_to_rest(const FrameMaking& making, Roll& roll) {
  for (PointsF& body : roll.body) body = PointsF(roll.body[1]);
  for (PointsF& cloth : roll.cloth) cloth = PointsF(roll.cloth[1]);
  push_out(roll.scene->graph.body, roll.body[1].cast<double>(), push_out_margin, roll.start);
  RollingState state;
  begin_roll(roll, state);
  double moved = 0;
  for (int frame = 0; frame < frames_to_rest; ++frame) {
    const Points x = minimised(making, state, state.now.x, 200).x;
    moved = (x - state.now.x).rowwise().norm().maxCoeff();
    state.now.x = state.now.previous = x;
  }
  roll.start = state.now.x;
  return moved < moves_at_rest;
}

std::vector<Roll> four_tangles(RollMaker& maker) {
  FrameMaking making{maker.features, maker.options.objective, 1, 1};
  making.losses.volume.weight = {0, 0};
  std::vector<Roll> found;
  for (int clip = 0; clip < static_cast<int>(maker.world.bodies[0].clips.size()); ++clip)
    for (int frame = 5; frame + 3 < frame_count(maker.world, 0, clip) && found.size() < 4; frame += 15) {
      RollRequest request;
      request.clip = clip;
      request.first_frame = frame;
      request.still = false;
      Roll roll = make_roll(maker, request);
      if (volume_at(roll, roll.start) > least_volume && come_to_rest(making, roll) &&
          volume_at(roll, roll.start) > least_volume && volume_at(roll, roll.start) < most_volume)
        found.push_back(std::move(roll));
    }
  return found;
}

// How much of the volume is left after the steps, of what it is where the cloth goes on without forces.
double left_after(double weight) {
  const auto trainer = make_trainer(tangle_training(weight));
  std::vector<Roll> rolls;
  trainer->queue->locked([&] { rolls = four_tangles(*trainer->maker); });
  REQUIRE(rolls.size() == 4);
  const auto begin = [&] {
    for (std::size_t k = 0; k < rolls.size(); ++k) begin_roll(rolls[k], trainer->pool[k]);
  };
  for (int step = 0; step < trainer->options.steps; ++step) {
    begin();
    REQUIRE(train_step(*trainer).adam.taken);
  }
  begin();
  double before = 0, after = 0;
  for (std::size_t k = 0; k < rolls.size(); ++k) {
    RollingState& state = trainer->pool[k];
    NextCloth next;
    REQUIRE(predict(*trainer, frame_making(*trainer), state, next));
    before += volume_at(rolls[k], state.now.x + state.now.velocity);
    after += volume_at(rolls[k], next.x);
  }
  WARN("weight " << weight << ": " << 1e6 * before << " cm3 become " << 1e6 * after);
  return after / before;
}

}  // namespace

TEST_CASE("training of SENC: on fixed tangles the volume loss takes the volume away, and nothing else does",
          "[training][.long]") {
  CHECK(left_after(3e4) < 0.3);
  CHECK(left_after(0) > 0.8);
}

}  // namespace selvedge::test_senc_tangles
