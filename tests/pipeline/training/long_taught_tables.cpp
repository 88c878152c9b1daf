#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "learned/losses/cloth_losses.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/training/simulate_frames.hpp"
#include "pipeline/training/training_watch.hpp"
#include "tests/pipeline/training/tiny_training.hpp"

namespace selvedge::long_taught_tables {

// How far a network that the solver has taught is from the solver's own roll-out, beside the same network without an
// output, which is the stepper `carried`, or `carried_rough` with a solve behind it. Takes some minutes.
// SELVEDGE_WEIGHTS: the network. SELVEDGE_TAUGHT_CLIPS: clips with commas between, instead of those below.
// SELVEDGE_TAUGHT_STARTS: roll-outs a clip.

namespace {

constexpr int frames = 10, settling = 20;

std::vector<std::string> names_in(const char* text, const std::string& otherwise) {
  std::vector<std::string> names(1);
  for (const char c : text ? std::string(text) : otherwise)
    c == ',' ? (void)names.emplace_back() : names.back().push_back(c);
  return names;
}

// The solver's frames from the start of a roll-out.
std::vector<Points> solver_frames(const Trainer& trainer, const Roll& roll) {
  RollingState start;
  begin_roll(roll, start);
  State at = solver_frame(start).from;
  const auto solver = make_teacher_stepper(roll.scene->scene, trainer.options.teacher);
  std::vector<Points> ends;
  for (std::size_t k = 2; k < roll.body.size(); ++k) {
    const SkinnedFrame end{roll.body[k], roll.cloth[k]};
    REQUIRE(simulate_frames(*solver, roll.scene->scene, roll.forces, {&end, 1}, at));
    ends.push_back(at.x);
  }
  return ends;
}

// Distances from the solver's frames [mm]: of the first frame before anything runs behind the network, and of all.
struct Distances {
  double before = 0;
  std::vector<double> after;
};

Distances distances(Trainer& trainer, const Roll& roll, BehindNetwork behind, const std::vector<Points>& ends) {
  const FrameMaking making = frame_making(trainer);
  const LossGarment& losses = roll.scene->losses;
  Distances found;
  RollingState state;
  begin_roll(roll, state);
  state.behind = make_behind(roll.scene->scene, behind);
  while (!state.over) {
    NextCloth next;
    REQUIRE(predict(trainer, making, state, next));
    if (state.frame == 0) found.before = target_loss(losses, ends[0], next.x, nullptr);
    REQUIRE(pass_behind(state, next));
    found.after.push_back(target_loss(losses, ends[static_cast<std::size_t>(state.frame)], next.x, nullptr));
    take_pass(making, next, HUGE_VAL, state);
  }
  return found;
}

// Sums over roll-outs.
struct Row {
  double before = 0, first = 0, third = 0, last = 0;
  void add(const Distances& d) {
    before += d.before;
    first += d.after[0];
    third += d.after[2];
    last += d.after[frames - 1];
  }
  void print(const std::string& name, int count) const {
    fmt::print("| {:<22} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", name, before / count, first / count, third / count,
               last / count);
    std::fflush(stdout);
  }
};

}  // namespace

TEST_CASE("taught network: distance from the solver's roll-out", "[.][taught_tables]") {
  const char* file = std::getenv("SELVEDGE_WEIGHTS");
  REQUIRE(file);
  const WeightFile weights = read_weight_file(file);
  const char* starts_text = std::getenv("SELVEDGE_TAUGHT_STARTS");
  const int starts = starts_text ? std::atoi(starts_text) : 4;
  TrainingOptions options = read_training(config_folder() / "training" / "student.yaml");
  options.samples.clips = names_in(std::getenv("SELVEDGE_TAUGHT_CLIPS"), "walk,squat,dance_twist,arms_up_down");
  auto student = make_empty_trainer(options), zero = make_empty_trainer(options);
  REQUIRE(weights.architecture.features.base == OutputBase::carried);
  student->architecture = zero->architecture = weights.architecture;
  student->network = make_training_network(weights.architecture, weights.weights);
  zero->network = make_training_network(weights.architecture, weights.weights);
  AffineLayer& last = zero->network.weights.decoder.layers.back();
  last.weight.setZero();
  std::ranges::fill(last.bias, 0.f);
  lay_out(zero->network);

  const std::vector<std::string> names{"carried", "student, response", "carried_rough", "student, rough solve"};
  std::vector<Row> all(names.size());
  std::vector<double> log_ratio(2, 0);  // of the last frame, student over zero output
  int count = 0;
  for (std::size_t clip = 0; clip < options.samples.clips.size(); ++clip) {
    std::vector<Row> rows(names.size());
    for (int k = 0; k < starts; ++k) {
      RollRequest request;
      request.clip = static_cast<int>(clip);
      request.still = false;
      request.frames = frames;
      request.simulated = settling;
      const int there = frame_count(zero->maker->world, 0, request.clip);
      request.first_frame = (2 * k + 1) * (there - frames) / (2 * starts);
      const Roll roll = make_roll(*zero->maker, request);
      REQUIRE(roll.usable);
      const std::vector<Points> ends = solver_frames(*zero, roll);
      for (std::size_t r = 0; r < names.size(); ++r) {
        const BehindNetwork behind = r < 2 ? BehindNetwork::response : BehindNetwork::solve;
        const Distances d = distances(r % 2 == 0 ? *zero : *student, roll, behind, ends);
        rows[r].add(d);
        all[r].add(d);
        const double sign = r % 2 == 0 ? -1 : 1;
        log_ratio[r / 2] += sign * std::log(d.after.back());
      }
      ++count;
    }
    fmt::print("\n| {} | network alone | 1 frame | 3 | {} frames |\n|---|---|---|---|---|\n",
               options.samples.clips[clip], frames);
    for (std::size_t r = 0; r < names.size(); ++r) rows[r].print(names[r], starts);
  }
  fmt::print("\n| all {} roll-outs | network alone | 1 frame | 3 | {} frames |\n|---|---|---|---|---|\n", count,
             frames);
  for (std::size_t r = 0; r < names.size(); ++r) all[r].print(names[r], count);
  fmt::print(
      "after {} frames the student is at {:.2f} times the distance of `carried`, with a rough solve at {:.2f} "
      "times that of `carried_rough` (geometric means)\n",
      frames, std::exp(log_ratio[0] / count), std::exp(log_ratio[1] / count));
}

}  // namespace selvedge::long_taught_tables
