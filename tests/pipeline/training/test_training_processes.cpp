#include <catch2/catch.hpp>

#include <sstream>

#include "collision/geometry/error.hpp"
#include "learned/network/weights_hdf5.hpp"
#include "pipeline/host/csv_columns.hpp"
#include "pipeline/processes/together.hpp"
#include "pipeline/training/train.hpp"
#include "pipeline/training/training_checkpoint_hdf5.hpp"
#include "tests/pipeline/files.hpp"
#include "tests/pipeline/processes/turns.hpp"
#include "tests/pipeline/training/tiny_training.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_training_processes {

using fake::few_steps;
using fake::Folder;
using fake::Turns;
using fake::weights_of;

// Training on several processes, for which threads stand in. With mpirun: tests/pipeline/commands/test_mpirun.cpp.

namespace {

// What is learned depends on the samples alone: all roll-outs have two frames of one pass, and none is given up.
TrainingOptions with_samples_in_turn(int states_and_batch) {
  TrainingOptions options = few_steps(2);
  options.pool.frames = {2, 2, 0, 0.5};
  options.pool.random_length = false;
  options.pool.passes = 1;
  options.pool.reset_distance = 1e6;
  options.pool.states = options.optimiser.batch = states_and_batch;
  options.optimiser.learning_rate = 1e-4;  // losses that fall smoothly do not make rounding large
  return options;
}

struct Steps {
  std::vector<double> losses;         // of this process's samples, summed in each step [J]
  std::vector<float> first, weights;  // before the first step and after the last
  std::vector<float> gradients;       // of the first step's decoder
};

Steps some_steps(const TrainingOptions& options, int count, Processes* processes = nullptr) {
  Steps steps;
  const auto trainer = make_trainer(options, processes);
  steps.first = weights_of(*trainer);
  for (int k = 0; k < count; ++k) {
    const StepRecord record = train_step(*trainer);
    double sum = 0;
    for (const SampleRecord& sample : record.samples) sum += sample.sum;
    steps.losses.push_back(sum);
    if (k > 0) continue;
    const FeatureRows& last = trainer->gradients.decoder.layers.back().weight;
    steps.gradients.assign(last.data(), last.data() + last.size());
  }
  steps.weights = weights_of(*trainer);
  return steps;
}

std::vector<Steps> steps_of_ranks(const TrainingOptions& options, int count, const std::vector<int>& order,
                                  int threads = 1) {
  std::vector<Steps> steps(order.size());
  for (const std::exception_ptr& one : Turns(order).run([&](Processes& processes) {
         with_threads(threads, [&] {
           steps[static_cast<std::size_t>(processes.rank())] = some_steps(options, count, &processes);
         });
       }))
    if (one) std::rethrow_exception(one);
  return steps;
}

double distance(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::pow(double(a[k]) - double(b[k]), 2);
  return std::sqrt(sum);
}

// The messages of what processes have thrown; empty where a process has thrown nothing.
std::vector<std::string> messages(const std::vector<std::exception_ptr>& thrown) {
  std::vector<std::string> all;
  for (const std::exception_ptr& one : thrown) {
    all.emplace_back();
    try {
      if (one) std::rethrow_exception(one);
    } catch (const std::exception& problem) {
      all.back() = problem.what();
    }
  }
  return all;
}

// The parts of checkpoints in the folder.
std::vector<std::filesystem::path> parts_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename().string().find(".rank") != std::string::npos) parts.push_back(entry.path());
  std::ranges::sort(parts);
  return parts;
}

std::vector<std::string> resumed_messages(const std::filesystem::path& checkpoint, const TrainingOptions& options,
                                          int count) {
  std::vector<int> order;
  for (int k = 0; k < count; ++k) order.push_back(k);
  return messages(Turns(order).run([&](Processes& processes) {
    together(&processes, [&] {
      TrainingHistory history;
      read_training_checkpoint(checkpoint, options, history, count > 1 ? &processes : nullptr);
      wait_for_all(processes);
    });
  }));
}

}  // namespace

TEST_CASE("training processes: two with a sample each learn what one does with both samples", "[training][processes]") {
  constexpr int steps = 8;
  const Steps one = some_steps(with_samples_in_turn(2), steps);
  const std::vector<Steps> two = steps_of_ranks(with_samples_in_turn(1), steps, {0, 1});
  CHECK(two[0].weights == two[1].weights);
  for (std::size_t k = 0; k < steps; ++k) {
    INFO("step " << k);
    CHECK(two[0].losses[k] + two[1].losses[k] == Approx(one.losses[k]).epsilon(1e-3));
    CHECK(two[0].losses[k] != two[1].losses[k]);
  }
  CHECK(two[0].losses[0] + two[1].losses[0] == Approx(one.losses[0]).epsilon(1e-6));
  CHECK(distance(two[0].first, one.first) < 1e-6 * distance(one.first, std::vector<float>(one.first.size())));
  CHECK(distance(two[0].gradients, one.gradients) <
        1e-4 * distance(one.gradients, std::vector<float>(one.gradients.size())));
  CHECK(distance(two[0].gradients, two[1].gradients) == 0);
  // Adam's first steps turn rounding of small gradients into their signs.
  CHECK(distance(two[0].weights, one.weights) < 0.02 * distance(one.weights, one.first));
}

TEST_CASE("training processes: the same bits whoever is first, and on any number of threads", "[training][processes]") {
  TrainingOptions options = few_steps(2);
  options.optimiser.freeze_statistics = GENERATE(true, false);
  INFO("frozen statistics: " << options.optimiser.freeze_statistics);
  const std::vector<Steps> before = steps_of_ranks(options, 8, {0, 1, 2}),
                           again = steps_of_ranks(options, 8, {2, 0, 1}, 2);
  for (std::size_t rank = 0; rank < 3; ++rank) {
    CHECK(before[rank].weights == before[0].weights);
    CHECK(again[rank].weights == before[0].weights);
    CHECK(again[rank].losses == before[rank].losses);
  }
  CHECK(before[1].losses != before[0].losses);
  CHECK(before[1].first != before[1].weights);
}

TEST_CASE("training processes: what they go on from has the same bits, and fits as a whole", "[training][processes]") {
  const Folder folder("train_processes");
  const TrainingOptions options = few_steps(2);
  const auto file = folder.path / "checkpoint.h5";
  std::vector<std::vector<float>> whole(2), resumed(2);
  std::vector<TrainingCounts> counts(2), counts_resumed(2);
  const auto thrown = Turns({0, 1}).run([&](Processes& processes) {
    const auto rank = static_cast<std::size_t>(processes.rank());
    const auto trainer = make_trainer(options, &processes);
    for (int k = 0; k < 3; ++k) train_step(*trainer);
    write_training_checkpoint(file, *trainer, {"old\n", "old\n", 0, 0, 0});
    for (int k = 0; k < 4; ++k) train_step(*trainer);
    write_training_checkpoint(file, *trainer, {"steps\n", "measures\n", 3, 0.5, 7});
    for (int k = 0; k < 6; ++k) train_step(*trainer);
    whole[rank] = weights_of(*trainer);
    counts[rank] = trainer->counts;
  });
  CHECK(messages(thrown) == std::vector<std::string>{"", ""});
  CHECK(parts_in(folder.path).size() == 2);  // those of the first checkpoint are gone
  const auto thrown_resumed = Turns({1, 0}).run([&](Processes& processes) {
    const auto rank = static_cast<std::size_t>(processes.rank());
    TrainingHistory history;
    const auto trainer = read_training_checkpoint(file, options, history, &processes);
    if (history.steps != "steps\n" || history.best_step != 7) throw std::logic_error("another history");
    if (trainer->counts.step != 7) throw std::logic_error("another step");
    for (int k = 0; k < 6; ++k) train_step(*trainer);
    resumed[rank] = weights_of(*trainer);
    counts_resumed[rank] = trainer->counts;
  });
  CHECK(messages(thrown_resumed) == std::vector<std::string>{"", ""});
  for (std::size_t rank = 0; rank < 2; ++rank) {
    CHECK(resumed[rank] == whole[0]);
    CHECK(counts_resumed[rank].rolls == counts[rank].rolls);
    CHECK(counts_resumed[rank].frames == counts[rank].frames);
  }

  // Another number of processes is refused with a sentence.
  for (const int count : {1, 3})
    for (const std::string& message : resumed_messages(file, options, count)) {
      INFO(count << ": " << message);
      CHECK(message.find("the checkpoint is of 2 processes, and " + std::to_string(count) + " train") !=
            std::string::npos);
      CHECK(message.find("mpirun -n 2") != std::string::npos);
    }
  // A part that is damaged, of another rank, or missing is one error of both.
  const std::filesystem::path second = parts_in(folder.path)[1];
  const std::string good = fake::whole(second);
  const auto both_fail = [&] {
    const std::vector<std::string> all = resumed_messages(file, options, 2);
    CHECK(all[0] == all[1]);
    CHECK(all[0].starts_with("process 1: " + second.string()));
  };
  std::string bad = good;
  bad[2 * bad.size() / 3] ^= 0x55;
  fake::write(folder, second.filename().string(), bad);
  both_fail();
  fake::write(folder, second.filename().string(), fake::whole(parts_in(folder.path)[0]));
  both_fail();
  std::filesystem::remove(second);
  both_fail();
}

TEST_CASE("training processes: a checkpoint of which a part cannot be written leaves the one before",
          "[training][processes]") {
  const Folder folder("train_processes_full");
  const TrainingOptions options = few_steps(2);
  const auto file = folder.path / "checkpoint.h5";
  const auto failed = messages(Turns({0, 1}).run([&](Processes& processes) {
    together(&processes, [&] {
      const auto trainer = make_trainer(options, &processes);
      train_step(*trainer);
      write_training_checkpoint(file, *trainer, {"a\n", "b\n", 0, 0, 0});
      train_step(*trainer);
      // Process 1 sees no folder, as on a machine that does not share it.
      const auto other = processes.rank() == 1 ? folder.path / "gone" / "checkpoint.h5" : file;
      write_training_checkpoint(other, *trainer, {"a\n", "b\n", 0, 0, 0});
    });
  }));
  CHECK(failed[0].starts_with("process 1: "));
  CHECK(failed[0] == failed[1]);
  const auto thrown = messages(Turns({0, 1}).run([&](Processes& processes) {
    TrainingHistory history;
    const auto trainer = read_training_checkpoint(file, options, history, &processes);
    if (trainer->counts.step != 1) throw std::logic_error("another step");
    write_training_checkpoint(file, *trainer, history);
  }));
  CHECK(thrown == std::vector<std::string>{"", ""});
  CHECK(parts_in(folder.path).size() == 2);  // what the failure left is gone

  // One process that trains anew in the folder leaves no parts there.
  const auto trainer = make_trainer(options);
  write_training_checkpoint(file, *trainer, {"a\n", "b\n", 0, 0, 0});
  CHECK(parts_in(folder.path).empty());
  for (const std::string& message : resumed_messages(file, options, 2))
    CHECK(message.find("the checkpoint is of 1 process, and 2 train now") != std::string::npos);
}

TEST_CASE("training processes: a run has one log and one table, and any process stops or ends it",
          "[training][processes]") {
  const Folder folder("train_processes_run");
  std::vector<std::ostringstream> logs(2);
  const auto request_of = [&](const std::string& out, Processes& processes) {
    return TrainRequest{config_folder() / "training" / "tiny.yaml",
                        {"steps=12", "pool.states=3", "optimiser.warm_up=4", "watch.frames=3", "watch.fixed_states=2"},
                        folder.path / out,
                        false,
                        &logs[static_cast<std::size_t>(processes.rank())],
                        {},
                        &processes};
  };
  const auto run = [&](const std::string& out, const std::function<void(TrainRequest&)>& change) {
    return messages(Turns({0, 1}).run([&](Processes& processes) {
      TrainRequest request = request_of(out, processes);
      change(request);
      train(request);
    }));
  };
  const std::vector<std::string> well{"", ""};
  CHECK(run("whole", [](TrainRequest&) {}) == well);
  CHECK(logs[0].str().find("2 processes, 2 samples a step") != std::string::npos);
  CHECK(logs[1].str().empty());
  const CsvColumns table(fake::whole(folder.path / "whole" / "steps.csv"));
  CHECK(table["step"].size() == 12);
  CHECK(table["samples"] == std::vector<double>(12, 2));  // of both
  // Process 1 is asked to stop after its fifth step, and both go on later.
  int asked = 0;
  CHECK(run("stopped", [&](TrainRequest& request) {
          if (request.processes->rank() == 1) request.stop = [&] { return ++asked == 5; };
        }) == well);
  CHECK(CsvColumns(fake::whole(folder.path / "stopped" / "steps.csv"))["step"].back() == 5);
  CHECK(run("stopped", [](TrainRequest& request) { request.resume = true; }) == well);
  const auto weights = [&](const std::string& out) {
    const WeightFile file = read_weight_file(folder.path / out / "weights.h5");
    return file.weights.decoder.layers.back().weight;
  };
  CHECK(weights("stopped") == weights("whole"));
  // A process that fails ends both, with one message; so does one that has read another file.
  const auto failed = run("failed", [](TrainRequest& request) {
    if (request.processes->rank() == 1)
      request.stop = []() -> bool { throw Error("is broken", "process one", "mend it"); };
  });
  CHECK(failed[0] == "process 1: process one: is broken\n  cure: mend it");
  CHECK(failed[1] == failed[0]);
  const auto other = run("other", [](TrainRequest& request) {
    if (request.processes->rank() == 1) request.overrides.push_back("seed=5");
  });
  CHECK(other[0].find("processes 0 and 1 have different programs, training files or inputs") != std::string::npos);
  CHECK(other[1] == other[0]);
}

}  // namespace selvedge::test_training_processes
