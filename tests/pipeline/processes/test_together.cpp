#include <catch2/catch.hpp>

#include <cstdlib>

#include "learned/gradients/training_network.hpp"
#include "learned/graph/make_graph.hpp"
#include "learned/network/weights.hpp"
#include "pipeline/processes/learning_sums.hpp"
#include "pipeline/processes/mpi_processes.hpp"
#include "pipeline/processes/together.hpp"
#include "tests/learned/random_graph.hpp"
#include "tests/pipeline/processes/turns.hpp"

namespace selvedge::test_together {

using fake::Turns;

// Numbers and failures of several processes, for which threads stand in. With Open MPI: test_mpirun.cpp.

namespace {

const std::vector<std::vector<int>> orders = {{0}, {0, 1}, {1, 0}, {0, 1, 2}, {2, 0, 1}, {4, 1, 3, 0, 2}};

// What each process does with itself must throw nothing.
void run_well(const std::vector<int>& order, const std::function<void(Processes&)>& work) {
  for (const std::exception_ptr& one : Turns(order).run(work))
    if (one) std::rethrow_exception(one);
}

std::vector<SharedFailure> failures(const std::vector<int>& order, const std::function<void(Processes&)>& work) {
  std::vector<SharedFailure> all;
  for (const std::exception_ptr& one : Turns(order).run([&](Processes& p) { together(&p, [&] { work(p); }); })) try {
      if (one) std::rethrow_exception(one);
    } catch (const SharedFailure& failure) {
      all.push_back(failure);
    }
  return all;
}

// Numbers of every size, whose sum depends on the order of its terms.
template <class T>
std::vector<T> numbers_of(int rank, std::size_t count) {
  std::vector<T> numbers;
  for (std::size_t k = 0; k < count; ++k)
    numbers.push_back(static_cast<T>(std::sin(1.3 * rank + 0.7 * double(k)) * std::pow(10, (rank + int(k)) % 5 * 3)));
  return numbers;
}

template <class T>
void check_sums(const std::vector<int>& order, std::size_t count) {
  std::vector<T> expected = numbers_of<T>(0, count);
  for (int rank = 1; rank < int(order.size()); ++rank) {
    const std::vector<T> more = numbers_of<T>(rank, count);
    for (std::size_t k = 0; k < count; ++k) expected[k] += more[k];
  }
  std::vector<std::vector<T>> got(order.size());
  run_well(order, [&](Processes& processes) {
    std::vector<T> numbers = numbers_of<T>(processes.rank(), count);
    add_up(processes, std::span(numbers));
    got[static_cast<std::size_t>(processes.rank())] = numbers;
  });
  for (const std::vector<T>& one : got) CHECK(one == expected);
}

}  // namespace

TEST_CASE("processes: sums are those in the order of ranks, to the bit, whoever is first", "[processes]") {
  for (const std::vector<int>& order : orders)
    for (const std::size_t count : {0, 1, 2, 7, 1000}) {
      INFO(order.size() << " processes, " << count << " numbers");
      check_sums<float>(order, count);
      check_sums<double>(order, count);
    }
  // The example can tell: the other order gives other bits.
  const std::vector<float> a = numbers_of<float>(0, 1000), b = numbers_of<float>(1, 1000),
                           c = numbers_of<float>(2, 1000);
  int differ = 0;
  for (std::size_t k = 0; k < a.size(); ++k) differ += (a[k] + b[k]) + c[k] != (c[k] + b[k]) + a[k];
  CHECK(differ > 100);
}

TEST_CASE("processes: every one gets the number of each", "[processes]") {
  run_well({2, 0, 1}, [](Processes& processes) {
    const auto all = gathered(processes, 10 + static_cast<std::uint64_t>(processes.rank()));
    wait_for_all(processes);
    if (all != std::vector<std::uint64_t>{10, 11, 12}) throw std::logic_error("other numbers");
  });
}

TEST_CASE("processes: where one fails, all fail with its message", "[processes]") {
  for (const std::vector<int>& order : orders) {
    if (order.size() < 2) continue;
    const auto failed = failures(order, [](Processes& processes) {
      float one = 1;
      add_up(processes, std::span(&one, 1));
      if (processes.rank() == 1) throw Error("is bad", "file.h5", "take another one");
      add_up(processes, std::span(&one, 1));
    });
    REQUIRE(failed.size() == order.size());
    for (const SharedFailure& one : failed) {
      CHECK(one.problem() == "is bad");
      CHECK(one.where() == "process 1: file.h5");
      CHECK(one.cure() == "take another one");
    }
  }
  // Of several the first rank's counts; process 0 speaks as one process does.
  const auto some = failures({2, 1, 0}, [](Processes& processes) {
    if (processes.rank() != 1) throw Error("failed in " + std::to_string(processes.rank()), "here", "");
    wait_for_all(processes);
  });
  REQUIRE(some.size() == 3);
  for (const SharedFailure& one : some) CHECK(std::string(one.what()) == "here: failed in 0");
  // Also what is no Error, and what comes in the middle of nothing else.
  const auto plain = failures({0, 1}, [](Processes& processes) {
    if (processes.rank() == 1) throw std::runtime_error("no memory");
    check_same(processes, 1, "numbers", "here", "");
  });
  REQUIRE(plain.size() == 2);
  CHECK(std::string(plain[0].what()) == "process 1: no memory");
}

TEST_CASE("processes: where they do not do the same, all fail", "[processes]") {
  const auto kinds = failures({0, 1}, [](Processes& processes) {
    std::vector<double> two(2);
    if (processes.rank() == 0)
      add_up(processes, std::span(two));
    else
      wait_for_all(processes);
  });
  CHECK(kinds.size() == 2);
  const auto sizes = failures({0, 1, 2}, [](Processes& processes) {
    std::vector<double> some(processes.rank() == 2 ? 3 : 2);
    add_up(processes, std::span(some));
  });
  REQUIRE(sizes.size() == 3);
  CHECK(sizes[1].problem() == "the processes do not do the same");
  const auto values = failures({0, 1, 2}, [](Processes& processes) {
    check_same(processes, processes.rank() == 2 ? 8 : 7, "programs", "training a", "take one");
  });
  REQUIRE(values.size() == 3);
  CHECK(values[0].problem() == "processes 0 and 2 have different programs");
}

TEST_CASE("processes: gradients become the mean over the samples of all", "[processes]") {
  const Architecture a = in_tests::with_size("tiny", 8, 1);
  const auto gradients_of = [&](int rank) { return random_weights(a, static_cast<std::uint64_t>(rank) + 1); };
  const std::vector<int> samples = {1, 0, 3};
  std::vector<NetworkWeights> got;
  for (int rank = 0; rank < 3; ++rank) got.push_back(gradients_of(rank));
  // A process without a sample has whatever its last step left.
  weight_arrays(a, got[1]).front().data[0] = std::numeric_limits<float>::quiet_NaN();
  std::vector<int> counts(3);
  run_well({1, 2, 0}, [&](Processes& processes) {
    const auto r = static_cast<std::size_t>(processes.rank());
    counts[r] = average_gradients(processes, a, samples[r], got[r]);
    check_same_weights(processes, a, got[r], "here");
  });
  CHECK(counts == std::vector<int>{4, 4, 4});
  NetworkWeights first = gradients_of(0), third = gradients_of(2);
  const auto mean = weight_arrays(a, got[1]), one = weight_arrays(a, first), three = weight_arrays(a, third);
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (int k = 0; mean[i].trained && k < mean[i].rows * mean[i].columns; ++k)
      REQUIRE(mean[i].data[k] == (one[i].data[k] + 3 * three[i].data[k]) / 4);
  run_well({0, 1}, [&](Processes& processes) {
    NetworkWeights none = gradients_of(processes.rank());
    if (average_gradients(processes, a, 0, none) != 0) throw std::logic_error("samples out of nothing");
    for (const WeightArray& array : weight_arrays(a, none))
      if (array.trained && array.data[0] != 0) throw std::logic_error("a gradient out of nothing");
  });
  const auto apart = failures({0, 1}, [&](Processes& processes) {
    NetworkWeights weights = gradients_of(0);
    if (processes.rank() == 1) weights.decoder.layers.back().bias[0] += 1e-6f;
    check_same_weights(processes, a, weights, "step 7");
  });
  REQUIRE(apart.size() == 2);
  CHECK(apart[0].problem() == "processes 0 and 1 have different weights");
}

TEST_CASE("processes: statistics are summed over all, and end with the most updates", "[processes]") {
  const FeatureOptions features = architecture_preset("tiny").features;
  std::vector<FeatureSums<double>> all(2, empty_sums(features));
  for (FeatureSums<double>& one : all) one.mesh_edge.updates = most_updates;
  run_well({1, 0}, [&](Processes& processes) {
    FeatureSums<double> own = empty_sums(features);
    for (DoubleAccumulators* set : {&own.node, &own.mesh_edge}) {
      set->rows = 10 + processes.rank();
      set->updates = 1;
      set->sum.assign(set->sum.size(), 0.1 * (1 + processes.rank()));
    }
    for (int k = 0; k < 2; ++k) add_statistics(processes, own, all[static_cast<std::size_t>(processes.rank())]);
  });
  for (const FeatureSums<double>& one : all) {
    CHECK(one.node.rows == 42);
    CHECK(one.node.updates == 4);
    CHECK(one.node.sum.front() == (0.1 + 0.2) + (0.1 + 0.2));
    CHECK(one.mesh_edge.rows == 0);
    CHECK(one.body_edge.rows == 0);
  }
}

TEST_CASE("processes: the library of Open MPI is opened where mpirun asks for it, and its absence is one error",
          "[processes]") {
  const char* count = "OMPI_COMM_WORLD_SIZE";
  unsetenv(count);
  CHECK_FALSE(processes_of_mpirun("nowhere/libselvedge_mpi.so"));
  setenv(count, "1", 1);
  CHECK_FALSE(processes_of_mpirun("nowhere/libselvedge_mpi.so"));
  setenv(count, "2", 1);
  CHECK_THROWS_WITH(processes_of_mpirun("nowhere/libselvedge_mpi.so"), Catch::Contains("make mpi"));
  unsetenv(count);
}

}  // namespace selvedge::test_together
