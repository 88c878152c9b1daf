#include "pipeline/processes/learning_sums.hpp"

#include <algorithm>

#include "pipeline/host/bytes_of.hpp"
#include "pipeline/host/kept_rows.hpp"
#include "pipeline/processes/together.hpp"

namespace selvedge {
namespace {

std::span<float> numbers_of(const WeightArray& array) {
  return {array.data, static_cast<std::size_t>(array.rows) * static_cast<std::size_t>(array.columns)};
}

}  // namespace

int average_gradients(Processes& processes, const Architecture& architecture, int samples, NetworkWeights& gradients) {
  const std::vector<WeightArray> arrays = weight_arrays(architecture, gradients);
  std::vector<float> numbers;
  for (const WeightArray& array : arrays)
    if (array.trained) numbers.insert(numbers.end(), numbers_of(array).begin(), numbers_of(array).end());
  const auto weight = static_cast<float>(samples);
  for (float& number : numbers) number = samples > 0 ? weight * number : 0;
  numbers.push_back(weight);
  add_up(processes, std::span(numbers));
  const float all = numbers.back();
  std::size_t at = 0;
  for (const WeightArray& array : arrays) {
    if (!array.trained) continue;
    for (float& number : numbers_of(array)) number = all > 0 ? numbers[at++] / all : 0;
  }
  return static_cast<int>(all);
}

void add_statistics(Processes& processes, const FeatureSums<double>& gathered, FeatureSums<double>& all) {
  std::vector<double> numbers;
  const auto pack = [&](const char*, const DoubleAccumulators& set) {
    numbers.insert(numbers.end(), {set.rows, set.updates});
    numbers.insert(numbers.end(), set.sum.begin(), set.sum.end());
    numbers.insert(numbers.end(), set.sum_squared.begin(), set.sum_squared.end());
  };
  visit_statistics(pack, gathered);
  add_up(processes, std::span(numbers));
  std::size_t at = 0;
  const auto add = [&](const char*, DoubleAccumulators& set) {
    const bool full = set.updates >= most_updates;
    const auto take = [&](double& sum) {
      sum += full ? 0 : numbers[at];
      ++at;
    };
    take(set.rows);
    take(set.updates);
    std::ranges::for_each(set.sum, take);
    std::ranges::for_each(set.sum_squared, take);
  };
  visit_statistics(add, all);
}

void check_same_weights(Processes& processes, const Architecture& architecture, const NetworkWeights& weights,
                        const std::string& where) {
  NetworkWeights copy = weights;
  std::uint64_t hash = hash_of("");
  for (const WeightArray& array : weight_arrays(architecture, copy)) hash = hash_of(bytes_of(numbers_of(array)), hash);
  check_same(processes, hash, "weights", where,
             "go on from the last checkpoint; if it happens again, their processors compute differently");
}

}  // namespace selvedge
