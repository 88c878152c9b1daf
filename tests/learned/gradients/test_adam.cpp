#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "collision/geometry/error.hpp"
#include "learned/gradients/adam.hpp"
#include "tests/learned/random_graph.hpp"

namespace selvedge::test_adam {

using in_tests::with_size;

namespace {

WeightGradients gradients_at(const Architecture& a, std::uint64_t seed, float factor) {
  WeightGradients gradients = random_weights(a, seed);
  for (const WeightArray& array : weight_arrays(a, gradients))
    for (int i = 0; i < array.rows * array.columns; ++i) array.data[i] *= array.trained ? factor : 0.f;
  return gradients;
}

bool same_weights(const Architecture& a, NetworkWeights one, NetworkWeights other) {
  const std::vector<WeightArray> first = weight_arrays(a, one), second = weight_arrays(a, other);
  for (std::size_t i = 0; i < first.size(); ++i)
    if (!std::equal(first[i].data, first[i].data + first[i].rows * first[i].columns, second[i].data)) return false;
  return true;
}

}  // namespace

TEST_CASE("adam: the first steps by hand", "[learned]") {
  // One weight with gradients 1, -2, 0.5: m = 0.1, -0.11, -0.049; v = 0.001, 0.004999, 0.005244001.
  const Architecture a = with_size("fine15", 1, 0);
  NetworkWeights weights = blank_weights(a);
  AdamState state = start_adam(a);
  AdamOptions options;
  options.learning_rate = 0.1;
  double expected = 0;
  const double g[] = {1, -2, .5}, m[] = {.1, -.11, -.049}, v[] = {.001, .004999, .005244001};
  for (int t = 0; t < 3; ++t) {
    WeightGradients gradients = zero_gradients(a);
    gradients.decoder.layers[0].bias[0] = static_cast<float>(g[t]);
    const AdamReport report = adam_step(a, options, gradients, state, weights);
    CHECK(report.taken);
    CHECK(report.norm == Approx(std::abs(g[t])));
    CHECK(report.scale == 1);
    const double step = 0.1 / (1 - std::pow(.9, t + 1)), root = std::sqrt(v[t] / (1 - std::pow(.999, t + 1)));
    expected -= step * m[t] / (root + 1e-8);
    CHECK(state.first.decoder.layers[0].bias[0] == Approx(m[t]).epsilon(1e-6));
    CHECK(state.second.decoder.layers[0].bias[0] == Approx(v[t]).epsilon(1e-5));
    CHECK(weights.decoder.layers[0].bias[0] == Approx(expected).epsilon(1e-5));
  }
  CHECK(weights.decoder.layers[0].weight.isZero());  // no gradient, no step
  CHECK(state.steps == 3);
}

TEST_CASE("adam: gradients are clipped to a norm, or to a multiple of the median of the last norms", "[learned]") {
  const Architecture a = with_size("tiny", 4, 1);
  NetworkWeights weights = random_weights(a, 1);
  AdamState state = start_adam(a);
  AdamOptions options;
  options.clip_norm = 2;
  const WeightGradients gradients = gradients_at(a, 3, 1);
  const AdamReport report = adam_step(a, options, gradients, state, weights);
  CHECK(report.norm > 2);
  CHECK(report.scale * report.norm == Approx(2));
  CHECK(state.first.decoder.layers[0].bias[0] ==
        Approx(.1 * report.scale * static_cast<double>(gradients.decoder.layers[0].bias[0])));
  options.clip_norm = 0;
  options.clip_median = 3;
  state = start_adam(a);
  for (int i = 0; i < 5; ++i) CHECK(adam_step(a, options, gradients, state, weights).scale == 1);
  CHECK(adam_step(a, options, gradients_at(a, 3, 2.9f), state, weights).scale == 1);
  CHECK(adam_step(a, options, gradients_at(a, 3, 30), state, weights).scale == Approx(.1));
}

TEST_CASE("adam: a gradient that is not finite changes nothing", "[learned]") {
  const Architecture a = with_size("tiny", 4, 1);
  NetworkWeights weights = random_weights(a, 1);
  AdamState state = start_adam(a);
  adam_step(a, {}, gradients_at(a, 2, 1), state, weights);
  const NetworkWeights before = weights;
  const AdamState kept = state;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    WeightGradients gradients = gradients_at(a, 3, 1);
    gradients.steps[0].node.layers[0].weight(1, 1) = bad;
    CHECK_FALSE(adam_step(a, {}, gradients, state, weights).taken);
    CHECK(same_weights(a, before, weights));
    CHECK(same_weights(a, kept.first, state.first));
    CHECK(state.steps == 1);
  }
}

TEST_CASE("adam: training goes on from its arrays with the same bits", "[learned]") {
  const Architecture a = with_size("small_contour", 5, 2);
  AdamOptions options;
  options.clip_median = 1;
  NetworkWeights weights = random_weights(a, 1), resumed;
  AdamState state = start_adam(a), again;
  for (int step = 0; step < 140; ++step) {
    if (step == 110) {
      resumed = weights;
      again = adam_from_arrays(a, adam_arrays(a, state), "test");
    }
    const WeightGradients gradients =
        gradients_at(a, 100 + static_cast<unsigned>(step), 1 + .01f * static_cast<float>(step % 7));
    adam_step(a, options, gradients, state, weights);
    if (step >= 110) adam_step(a, options, gradients, again, resumed);
  }
  CHECK(same_weights(a, weights, resumed));
  CHECK(again.steps == 140);
  CHECK(state.norms.size() == median_window);
}

TEST_CASE("adam: arrays that do not fit are errors that name them", "[learned]") {
  const Architecture a = with_size("tiny", 4, 1);
  const std::vector<NamedFloats> arrays = adam_arrays(a, start_adam(a));
  const auto place = [&](const auto& change) {
    std::vector<NamedFloats> changed = arrays;
    change(changed);
    try {
      adam_from_arrays(a, changed, "file");
    } catch (const Error& error) {
      return error.where();
    }
    return std::string("none");
  };
  CHECK(place([](auto&) {}) == "none");
  CHECK(place([](auto& list) { list.erase(list.begin()); }) == "file: " + arrays[0].name);
  CHECK(place([](auto& list) { list[3].values.pop_back(); }) == "file: " + arrays[3].name);
  CHECK(place([](auto& list) { list.push_back(list[2]); }) == "file: " + arrays[2].name);
  CHECK(place([](auto& list) { list.push_back({"adam/third", {1}}); }) == "file: adam/third");
  CHECK(place([](auto& list) { list[list.size() - 2].values = {.5f, 0}; }) == "file: adam/steps");
  CHECK(place([](auto& list) { list.back().values = {-1}; }) == "file: adam/norms");
  NetworkWeights weights = random_weights(a, 1);
  AdamState state = start_adam(a);
  CHECK_THROWS_AS(adam_step(a, {}, zero_gradients(with_size("tiny", 5, 1)), state, weights), Error);
}

TEST_CASE("initial weights: as published, and a last layer that is nearly zero", "[learned]") {
  const Architecture a = with_size("hood", 64, 1);
  NetworkWeights first = initial_weights(a, 3);
  CHECK(same_weights(a, first, initial_weights(a, 3)));
  CHECK_FALSE(same_weights(a, first, initial_weights(a, 4)));
  const FeatureRows& layer = first.steps[0].edges[0].layers[0].weight;  // 192 inputs
  CHECK(layer.cwiseAbs().maxCoeff() <= 1 / std::sqrt(192.f));
  CHECK(layer.cwiseAbs().maxCoeff() > .99f / std::sqrt(192.f));
  CHECK(std::abs(layer.mean()) < .002f);
  CHECK(layer.squaredNorm() / static_cast<float>(layer.size()) == Approx(1 / (3 * 192.)).epsilon(.05));
  const FeatureRows& table = first.tables.node_type;  // 81 numbers of deviation 1
  CHECK(table.squaredNorm() / static_cast<float>(table.size()) == Approx(1).epsilon(.5));
  CHECK(first.node_encoder.scale.front() == 1);
  NetworkWeights nearly = initial_weights(a, 3, .01);
  CHECK(nearly.decoder.layers.back().weight(1, 2) == Approx(.01f * first.decoder.layers.back().weight(1, 2)));
  CHECK(nearly.decoder.layers.back().bias[1] == Approx(.01f * first.decoder.layers.back().bias[1]));
  CHECK(nearly.decoder.layers.front().weight == first.decoder.layers.front().weight);
}

}  // namespace selvedge::test_adam
