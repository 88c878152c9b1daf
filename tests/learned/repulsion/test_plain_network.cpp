#include <catch2/catch.hpp>

#include <random>

#include "collision/geometry/error.hpp"
#include "learned/repulsion/plain_network.hpp"
#include "learned/repulsion/scale_network.hpp"
#include "tests/threads.hpp"

namespace selvedge::test_plain_network {

namespace {

FeatureRows random_rows(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, 1);
  FeatureRows made(rows, columns);
  for (float& x : made.reshaped()) x = normal(random);
  return made;
}

PlainNetwork skipping_network() {
  PlainShape shape{5, {12, 12, 12, 1}, Bend::softplus, 3, 2, 3};
  PlainNetwork made = make_plain_network(shape, 5);
  std::mt19937 random(2);
  std::normal_distribution<float> normal(0, 0.1f);
  for (AffineLayer& layer : made.layers)
    for (float& b : layer.bias) b = normal(random);
  return made;
}

FeatureRows tangents_of(const ValueAndGradient& made, const FeatureRows& directions) {
  return made.gradient.cwiseProduct(directions).rowwise().sum();
}

// A loss of outputs and of their derivatives in the directions, in double.
double loss_of(const PlainNetwork& n, const FeatureRows& inputs, const FeatureRows& directions) {
  const ValueAndGradient made = evaluate_with_gradient(n, inputs, n.inputs());
  const FeatureRows tangents = tangents_of(made, directions);
  double loss = 0;
  for (Eigen::Index i = 0; i < inputs.rows(); ++i)
    loss += 0.5 * std::pow(made.value(i, 0) - 0.3, 2) + 0.25 * std::pow(tangents(i, 0) - 0.1, 2);
  return loss;
}

}  // namespace

TEST_CASE("plain network: gradients of values and of derivatives agree with differences", "[plain_network]") {
  PlainNetwork network = skipping_network();
  const FeatureRows inputs = random_rows(7, 5, 1), directions = random_rows(7, 5, 2);
  const ValueAndGradient made = evaluate_with_gradient(network, inputs, network.inputs());
  PlainAdjoints adjoints{made.value.array() - 0.3f, 0.5f * (tangents_of(made, directions).array() - 0.1f)};
  const PlainGradients gradients = backward(network, inputs, directions, adjoints);

  constexpr float step = 3e-3f;
  std::vector<float> all = parameters_of(network);
  double worst = 0, largest = 0;
  for (std::size_t k = 0; k < all.size(); k += 3) {
    const float kept = all[k];
    all[k] = kept + step;
    set_parameters(all, network);
    const double above = loss_of(network, inputs, directions);
    all[k] = kept - step;
    set_parameters(all, network);
    const double below = loss_of(network, inputs, directions);
    all[k] = kept;
    worst = std::max(worst, std::abs((above - below) / (2 * step) - gradients.parameters[k]));
    largest = std::max(largest, std::abs(static_cast<double>(gradients.parameters[k])));
  }
  set_parameters(all, network);
  CHECK(largest > 0.1);
  CHECK(worst < 2e-3 * largest);

  for (Eigen::Index c = 0; c < inputs.cols(); ++c) {
    FeatureRows moved = inputs;
    moved(3, c) += step;
    const double above = loss_of(network, moved, directions);
    moved(3, c) -= 2 * step;
    CHECK((above - loss_of(network, moved, directions)) / (2 * step) ==
          Approx(gradients.inputs(3, c)).margin(2e-3 * largest));
  }
}

TEST_CASE("plain network: the gradient by the inputs is what goes back from the output", "[plain_network]") {
  for (const Bend bend : {Bend::softplus, Bend::rectified}) {
    PlainNetwork network = skipping_network();
    network.bend = bend;
    const FeatureRows inputs = random_rows(300, 5, 4);
    const ValueAndGradient made = evaluate_with_gradient(network, inputs, 3);
    CHECK(made.value == evaluate(network, inputs));
    const PlainGradients gradients = backward(network, inputs, {}, {FeatureRows::Ones(inputs.rows(), 1), {}});
    CHECK((gradients.inputs.leftCols(3) - made.gradient).cwiseAbs().maxCoeff() < 1e-5f);
  }
}

TEST_CASE("plain network: threads change no bit; shapes without a layer are refused", "[plain_network]") {
  const PlainNetwork network = skipping_network();
  const FeatureRows inputs = random_rows(700, 5, 6), none;
  PlainGradients one, three;
  const PlainAdjoints adjoints{FeatureRows::Ones(700, 1), {}};
  with_threads(1, [&] { one = backward(network, inputs, none, adjoints); });
  with_threads(3, [&] { three = backward(network, inputs, none, adjoints); });
  CHECK(one.parameters == three.parameters);
  CHECK(one.inputs == three.inputs);
  CHECK_THROWS_AS(make_plain_network({0, {3}}, 1), Error);
}

TEST_CASE("scale network: the paper's sizes have the paper's numbers of parameters", "[plain_network]") {
  const ScaleShape paper{72 + 10 + 4, 9723};
  CHECK(shared_latent_width(paper) / 9723.0 == Approx(9.9).epsilon(0.01));
  ScaleShape shape{86, 30};
  const ScaleNetwork made = make_scale_network(shape, 1);
  CHECK(parameter_count(made.h) == 2188288);
  CHECK(parameter_count(made.k) == 10250 * 30);
  CHECK(parameter_count(made.g) == 241);
  const PlainNetwork distance =
      make_plain_network({85, {1024, 1024, 1024, 1024, 1024, 1024, 1024, 1024, 1024, 1}, Bend::softplus, 100, 3, 3}, 1);
  CHECK(parameter_count(distance) == 8488961);
  shape.form = ScaleForm::shared_latent;
  const long long shared = parameter_count(make_scale_network(shape, 1));
  CHECK(std::abs(static_cast<double>(shared) / static_cast<double>(parameter_count(made)) - 1) < 0.001);
}

TEST_CASE("scale network: rows of k alone give what the whole of it gives, and the slope is the derivative",
          "[plain_network]") {
  for (const ScaleForm form : {ScaleForm::vertex_latents, ScaleForm::shared_latent, ScaleForm::distance_only})
    for (const ScaleRange range : {ScaleRange::at_least_one, ScaleRange::at_least_zero}) {
      ScaleShape shape{6, 20, 64};
      shape.form = form;
      shape.range = range;
      ScaleNetwork network = make_scale_network(shape, 3);
      const std::vector<float> inputs{0.1f, -0.4f, 0.3f, 0.9f, -1, 0.2f};
      const std::vector<int> vertices{3, 7, 19};
      const std::vector<double> distances{-0.002, -0.011, -0.03};
      for (const double alpha : ScaleEvaluator(network, inputs)(vertices, distances).alpha)
        CHECK(alpha == Approx(1.02).margin(0.1));
      network.g.layers.back().weight *= 100;
      const ScaleEvaluator evaluator(network, inputs);
      const Scales found = evaluator(vertices, distances);
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        CHECK(found.alpha[i] >= (range == ScaleRange::at_least_one ? 1 : 0));
        std::vector<double> more = distances, less = distances;
        more[i] += 1e-5;
        less[i] -= 1e-5;
        const double slope = (evaluator(vertices, more).alpha[i] - evaluator(vertices, less).alpha[i]) / 2e-5;
        CHECK(found.slope[i] == Approx(slope).epsilon(0.01).margin(0.05));
      }
      if (form != ScaleForm::vertex_latents) continue;
      FeatureRows at = Eigen::Map<const Eigen::RowVectorXf>(inputs.data(), 6);
      const FeatureRows latents = evaluate(network.k, evaluate(network.h, at).cwiseMax(0.0f));
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double distance = distances[i];
        const FeatureRows of_vertex = latents.middleCols(10 * vertices[i], 10);
        const double sum = evaluate(network.g, scale_inputs(network, of_vertex, {&distance, 1}))(0, 0);
        CHECK(found.alpha[i] == Approx(scale_end(range, sum)).epsilon(1e-5));
      }
    }
  CHECK_THROWS_AS(make_scale_network({0, 20, 64}, 1), Error);
  const ScaleNetwork network = make_scale_network({2, 3, 64}, 1);
  CHECK_THROWS_AS(ScaleEvaluator(network, std::vector<float>{1}), Error);
}

}  // namespace selvedge::test_plain_network
