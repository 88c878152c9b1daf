#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/host/folder_lock.hpp"
#include "pipeline/training/train.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/training/tiny_training.hpp"
#include "tests/refusal.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_train {

using fake::few_steps;
using fake::Folder;
using fake::weights_of;

namespace {

std::string error_of(const std::filesystem::path& checkpoint, const TrainingOptions& options) {
  return testing::refusal([&] {
    TrainingHistory history;
    read_training_checkpoint(checkpoint, options, history);
  });
}

}  // namespace

TEST_CASE("training: what is resumed goes on with the same bits", "[training]") {
  const Folder folder("train_resume");
  const TrainingOptions options = few_steps(3);
  auto whole = make_trainer(options);
  for (int k = 0; k < 11; ++k) train_step(*whole);
  TrainingHistory history{"steps\n", "measures\n", 3, 0.5, 7};
  write_training_checkpoint(folder.path / "checkpoint.h5", *whole, history);
  for (int k = 0; k < 15; ++k) train_step(*whole);

  TrainingHistory read;
  auto resumed = read_training_checkpoint(folder.path / "checkpoint.h5", options, read);
  CHECK(read.steps == history.steps);
  CHECK(read.best_step == 7);
  CHECK(resumed->counts.step == 11);
  for (int k = 0; k < 15; ++k) train_step(*resumed);
  CHECK(weights_of(*resumed) == weights_of(*whole));
  CHECK(resumed->random.state == whole->random.state);
  CHECK(resumed->counts.rolls == whole->counts.rolls);
  CHECK(resumed->counts.frames == whole->counts.frames);
  for (std::size_t k = 0; k < whole->pool.size(); ++k) {
    CHECK(resumed->pool[k].over == whole->pool[k].over);
    if (!whole->pool[k].over) CHECK(resumed->pool[k].now.x == whole->pool[k].now.x);
  }
  const auto moments = adam_arrays(whole->architecture, whole->adam);
  const auto moments_resumed = adam_arrays(resumed->architecture, resumed->adam);
  REQUIRE(moments.size() == moments_resumed.size());
  for (std::size_t k = 0; k < moments.size(); ++k) CHECK(moments[k].values == moments_resumed[k].values);
  // Another seed is another run.
  TrainingOptions other = options;
  other.seed = 9;
  CHECK(error_of(folder.path / "checkpoint.h5", other).find("another configuration") != std::string::npos);
}

TEST_CASE("training: libtorch goes the steps of the kernels, and a run may change the device", "[.torch]") {
  const Folder folder("train_device");
  TrainingOptions options = few_steps(3);
  auto ours = make_trainer(options);
  const std::vector<float> first = weights_of(*ours);
  options.device = NetworkDevice::automatic;
  if (!make_trainer(options)->torch) options.device = NetworkDevice::libtorch;
  auto theirs = make_trainer(options), again = make_trainer(options);
  for (int k = 0; k < 4; ++k)
    for (Trainer* trainer : {ours.get(), theirs.get(), again.get()}) train_step(*trainer);
  const std::vector<float> a = weights_of(*ours), b = weights_of(*theirs);
  CHECK(b == weights_of(*again));
  double change = 0, apart = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    change += std::pow(a[k] - first[k], 2);
    apart += std::pow(a[k] - b[k], 2);
  }
  CHECK(change > 0);
  CHECK(std::sqrt(apart / change) < 0.02);  // Adam's first steps turn rounding of small gradients into their signs
  write_training_checkpoint(folder.path / "checkpoint.h5", *theirs, {"a\n", "b\n", 0, 0, 0});
  options.device = NetworkDevice::cpu;
  TrainingHistory history;
  CHECK(read_training_checkpoint(folder.path / "checkpoint.h5", options, history)->counts.step == 4);
}

TEST_CASE("training: a batch has the same bits on any number of threads and when it is resumed", "[training]") {
  const Folder folder("train_batch");
  TrainingOptions options = few_steps(3);
  options.pool.states = 5;
  options.optimiser.batch = 3;
  auto whole = make_trainer(options), other = make_trainer(options);
  for (int k = 0; k < 6; ++k) {
    with_threads(1, [&] { CHECK(train_step(*whole).samples.size() == 3); });
    with_threads(2, [&] { train_step(*other); });
  }
  CHECK(weights_of(*whole) == weights_of(*other));
  CHECK(whole->counts.step == 6);
  write_training_checkpoint(folder.path / "checkpoint.h5", *whole, {"a\n", "b\n", 0, 0, 0});
  TrainingHistory history;
  auto resumed = read_training_checkpoint(folder.path / "checkpoint.h5", options, history);
  for (int k = 0; k < 6; ++k)
    for (Trainer* trainer : {whole.get(), resumed.get()}) train_step(*trainer);
  CHECK(weights_of(*whole) == weights_of(*resumed));
  CHECK(whole->counts.frames == resumed->counts.frames);
}

TEST_CASE("training: a sample of a batch without a finite loss is dropped, and the others are learned", "[training]") {
  TrainingOptions options = few_steps(3);
  options.optimiser.batch = options.pool.states;
  auto trainer = make_trainer(options);
  train_step(*trainer);
  for (RollingState& state : trainer->pool) REQUIRE_FALSE(state.over);
  trainer->pool[1].now.velocity(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<float> before = weights_of(*trainer);
  const StepRecord record = train_step(*trainer);
  CHECK(record.adam.taken);
  CHECK(std::ranges::count_if(record.samples, [](const SampleRecord& s) { return !s.bad.empty(); }) == 1);
  CHECK(trainer->counts.bad == 1);
  CHECK(trainer->counts.step == 2);
  CHECK(trainer->pool[1].over);
  const std::vector<float> after = weights_of(*trainer);
  CHECK(after != before);
  CHECK(std::ranges::all_of(after, [](float w) { return std::isfinite(w); }));
}

TEST_CASE("training: damaged and foreign checkpoints are one error", "[training]") {
  const Folder folder("train_damage");
  TrainingOptions options = few_steps(3);
  options.optimiser.warm_up = 1;
  auto trainer = make_trainer(options);
  const auto file = folder.path / "checkpoint.h5";
  write_training_checkpoint(file, *trainer, {"a\n", "b\n", 0, 0, 0});
  CHECK(error_of(folder.path / "none.h5", options).find("nothing to resume") != std::string::npos);
  const std::string good = fake::whole(file);
  for (const std::size_t at : {good.size() / 3, good.size() / 2, 2 * good.size() / 3}) {  // among the large arrays
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x55);
    fake::write(folder, "bad.h5", bad);
    INFO(at);
    CHECK_FALSE(error_of(folder.path / "bad.h5", options).empty());
  }
  fake::write(folder, "half.h5", good.substr(0, good.size() / 2));
  CHECK_FALSE(error_of(folder.path / "half.h5", options).empty());
  fake::write(folder, "text.h5", "not a checkpoint");
  CHECK_FALSE(error_of(folder.path / "text.h5", options).empty());
}

TEST_CASE("training: samples without a finite loss are left and counted, many in a row stop it", "[training]") {
  TrainingOptions options = few_steps(3);
  options.optimiser.warm_up = 2;
  options.watch.most_bad_samples = 5;
  auto trainer = make_trainer(options);
  train_step(*trainer);
  const std::vector<float> before = weights_of(*trainer);
  trainer->network.weights.decoder.layers.back().bias[0] = std::numeric_limits<float>::quiet_NaN();
  lay_out(trainer->network);
  for (int k = 0; k < 5; ++k) CHECK_FALSE(train_step(*trainer).adam.taken);
  CHECK(trainer->counts.bad == 5);
  CHECK(trainer->counts.step == 1);
  CHECK_THROWS_WITH(train_step(*trainer), Catch::Contains("in a row had no finite loss"));
  trainer->network.weights.decoder.layers.back().bias[0] = 0;
  CHECK(before.size() == weights_of(*trainer).size());
}

TEST_CASE("training: a run leaves its files, and one that is stopped goes on", "[training]") {
  const Folder folder("train_run");
  std::ostringstream log;
  int asked = 0;
  TrainRequest request{config_folder() / "training" / "tiny.yaml",
                       {"steps=24", "pool.states=3", "optimiser.warm_up=3", "watch.frames=3", "watch.fixed_states=2"},
                       folder.path / "run",
                       false,
                       &log,
                       [&asked] { return ++asked == 10; }};
  const TrainSummary stopped = train(request);
  CHECK_FALSE(stopped.finished);
  CHECK(stopped.counts.step == 10);
  request.resume = true;
  request.stop = {};
  {
    const FolderLock other(request.out);
    CHECK_THROWS_WITH(train(request), Catch::Contains("another run writes into this folder"));
  }
  const TrainSummary finished = train(request);
  CHECK(finished.finished);
  CHECK(finished.counts.step == 24);
  for (const char* name :
       {"checkpoint.h5", "weights.h5", "best.h5", "steps.csv", "measures.csv", "training.html", "config.yaml"})
    CHECK(std::filesystem::exists(request.out / name));
  const WeightFile weights = read_weight_file(request.out / "weights.h5");
  CHECK(weights.architecture.name == "tiny");
  CHECK(weights.training.find("steps: 24") != std::string::npos);
  const std::string measures = fake::whole(request.out / "measures.csv");
  CHECK(std::ranges::count(measures, '\n') == 4);  // titles, before the first step, half, end
  CHECK(fake::whole(request.out / "training.html").find("<polyline") != std::string::npos);
  CHECK(log.str().find("samples/s") != std::string::npos);
  CHECK_FALSE(pause_training(folder.path / "run", 0.2));
}

TEST_CASE("training: a network beside the carried guess learns in one pass, and goes on with the same bits",
          "[training][student]") {
  const Folder folder("train_student");
  TrainingOptions options = few_steps(3);
  options.architecture = "student";
  CHECK_THROWS_AS(make_trainer(options), Error);  // two passes
  options.pool.passes = 1;
  auto whole = make_trainer(options);
  const std::vector<float> first = weights_of(*whole);
  for (int k = 0; k < 7; ++k) train_step(*whole);
  write_training_checkpoint(folder.path / "checkpoint.h5", *whole, {"a\n", "b\n", 0, 0, 0});
  for (int k = 0; k < 7; ++k) train_step(*whole);
  TrainingHistory history;
  auto resumed = read_training_checkpoint(folder.path / "checkpoint.h5", options, history);
  for (int k = 0; k < 7; ++k) train_step(*resumed);
  CHECK(weights_of(*resumed) == weights_of(*whole));
  CHECK(weights_of(*whole) != first);
  CHECK(whole->counts.bad == 0);
}

TEST_CASE("training: what is minimised has the least sum of losses", "[training]") {
  RollMaker& maker = fake::tiny_maker();
  const FrameMaking making = fake::tiny_making();
  RollRequest request;
  request.first_frame = 40;
  RollingState state;
  begin_roll(make_roll(maker, request), state);
  const RestGraph& rest = state.roll.scene->rest;
  const SeenPositions seen = seen_positions(rest, state.now, making.features);
  const Points start = inertial_guess(rest, state.now, seen, making.features);
  const Minimised made = minimised(making, state, start, 400);
  const auto sum_at = [&](const Points& x) {
    return sum_of(add_losses(inputs_of(state, seen, x, 1), making.losses, state.losses, nullptr));
  };
  CHECK(made.value < sum_at(start));  // which is mostly the height of the cloth
  const auto slope_at = [&](const Points& x) {
    Points gradient = Points::Zero(x.rows(), 3);
    add_losses(inputs_of(state, seen, x, 1), making.losses, state.losses, &gradient);
    return gradient.norm();
  };
  CHECK(slope_at(made.x) < 0.2 * slope_at(start));
  CHECK(made.value == Approx(sum_at(made.x)));
  RandomStream random{3};
  for (int k = 0; k < 5; ++k) {
    Points x = made.x;
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += 2e-4 * random.normal();
    CHECK(sum_at(x) > made.value);
  }
}

TEST_CASE("training: a few hundred steps close part of the gap", "[training][.long]") {
  const Folder folder("train_tiny");
  std::ostringstream log;
  const TrainSummary summary =
      train({config_folder() / "training" / "tiny.yaml", {"steps=2500"}, folder.path, false, &log, {}});
  INFO(log.str());
  CHECK(summary.counts.bad == 0);
  CHECK(summary.last.skinned.closed > 0.3);
  CHECK(summary.last.minimised.closed > 0.5);
  CHECK(summary.last.roll.finite);
}

}  // namespace selvedge::test_train
