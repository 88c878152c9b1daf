#include <catch2/catch.hpp>

#include <random>

#include "collision/geometry/error.hpp"
#include "learned/repulsion/neural_distance.hpp"

namespace selvedge::test_neural_distance {

namespace {

// Balls of two sizes, each known by its radius; every third point lies on the surface.
DistanceSamples ball_samples(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  DistanceSamples made;
  made.points.resize(count, 3);
  made.normals = FeatureRows::Zero(count, 3);
  made.conditions.resize(2, 1);
  made.conditions << 0.5f, 0.8f;
  made.queries = {point_query(), point_query()};
  for (int i = 0; i < count; ++i) {
    const int body = i % 2;
    const double radius = static_cast<double>(made.conditions(body, 0));
    Vec3 p = 0.6 * Vec3(normal(random), normal(random), normal(random));
    if (i % 3 == 0) {
      p = radius * p.normalized();
      made.normals.row(i) = p.normalized().transpose().cast<float>();
    }
    made.points.row(i) = p.transpose();
    made.distance.push_back(static_cast<float>(p.norm() - radius));
    made.on_surface.push_back(i % 3 == 0);
    made.body.push_back(body);
  }
  return made;
}

PlainNetwork narrow_distance(int query, int condition, double beta) {
  return make_neural_distance({.query = query, .condition = condition, .layers = 4, .width = 24, .beta = beta}, 3);
}

}  // namespace

TEST_CASE("neural distance: the gradient of all three losses agrees with differences", "[neural_distance]") {
  PlainNetwork network = narrow_distance(3, 1, 4);
  const DistanceSamples samples = ball_samples(30, 1);
  for (const DistanceLossWeights& weights :
       {DistanceLossWeights{2, 0, 0}, DistanceLossWeights{0, 1, 0}, DistanceLossWeights{0, 0, 0.1}}) {
    const DistanceLosses made = distance_losses(network, samples, weights);
    std::vector<float> all = parameters_of(network);
    double worst = 0, largest = 0;
    constexpr float step = 2e-3f;
    for (std::size_t k = 0; k < all.size(); k += 29) {
      const float kept = all[k];
      all[k] = kept + step;
      set_parameters(all, network);
      const double above = distance_losses(network, samples, weights).total;
      all[k] = kept - step;
      set_parameters(all, network);
      const double below = distance_losses(network, samples, weights).total;
      all[k] = kept;
      worst = std::max(worst, std::abs((above - below) / (2 * step) - static_cast<double>(made.gradient[k])));
      largest = std::max(largest, std::abs(static_cast<double>(made.gradient[k])));
    }
    set_parameters(all, network);
    CHECK(largest > 1e-3);
    CHECK(worst < 0.02 * largest);
  }
}

TEST_CASE("neural distance: errors are those of all samples and of the near ones", "[neural_distance]") {
  PlainNetwork network = narrow_distance(3, 1, 20);
  set_parameters(std::vector<float>(static_cast<std::size_t>(parameter_count(network)), 0), network);
  network.layers.back().bias[0] = 0.01f;  // 1 cm outside everywhere
  DistanceSamples samples = ball_samples(4, 2);
  samples.distance = {-0.01f, 0.04f, -0.2f, 0.0f};
  const DistanceErrors errors = distance_errors(network, samples);
  CHECK(errors.absolute == Approx((0.02 + 0.03 + 0.21 + 0.01) / 4));
  CHECK(errors.near == Approx((0.02 + 0.03 + 0.01) / 3));
  CHECK(errors.wrong_side == Approx(100.0 / 3));
  CHECK(errors.relative == Approx((200 + 75 + 105) / 3.0));
}

TEST_CASE("neural distance: training fits balls that it is told of, values and gradients", "[neural_distance]") {
  PlainNetwork network = narrow_distance(3, 1, 20);
  const DistanceSamples samples = ball_samples(240, 2), unseen = ball_samples(240, 9);
  const DistanceErrors before = distance_errors(network, unseen);
  PlainAdam adam;
  adam.rate = 4e-3;
  for (int step = 0; step < 200; ++step) {
    if (step == 150) adam.rate = 5e-4;
    REQUIRE(take_step(adam, distance_losses(network, samples, {}).gradient, network));
  }
  const DistanceErrors after = distance_errors(network, unseen);
  CHECK(after.absolute < 0.06);
  CHECK(after.absolute < 0.3 * before.absolute);
  const std::vector<float> bad(static_cast<std::size_t>(parameter_count(network)), std::nanf(""));
  const std::vector<float> kept = parameters_of(network);
  CHECK_FALSE(take_step(adam, bad, network));
  CHECK(parameters_of(network) == kept);

  const float radius = 0.5f;
  const NeuralDistance ball(network, point_query(), {&radius, 1});
  std::vector<SignedDistance> found;
  Points at(2, 3);
  at << 0.3, 0.1, 0.2, 0.5, -0.4, 0.3;
  ball.ask(at, found);
  for (int i = 0; i < 2; ++i) {
    CHECK(found[static_cast<std::size_t>(i)].value == Approx(at.row(i).norm() - 0.5).margin(0.08));
    CHECK(found[static_cast<std::size_t>(i)].gradient.normalized().dot(row(at, i).normalized()) > 0.9);
  }
}

TEST_CASE("neural distance: derivatives go through bones, and folding the body changes nothing", "[neural_distance]") {
  std::vector<Eigen::Matrix<double, 3, 4>> frames(3);
  for (std::size_t b = 0; b < 3; ++b) {
    frames[b].leftCols<3>() =
        Eigen::AngleAxisd(0.4 + static_cast<double>(b), Vec3(1, static_cast<double>(b), 2).normalized())
            .toRotationMatrix();
    frames[b].col(3) = Vec3(0.1, -0.2, 0.1 * static_cast<double>(b));
  }
  const QueryMap bones = bone_query(frames);
  const PlainNetwork network = narrow_distance(9, 2, 3);
  const std::vector<float> condition{0.3f, -1.2f};
  const NeuralDistance field(network, bones, condition);
  Points at(1, 3);
  at << 0.2, 0.4, -0.1;
  std::vector<SignedDistance> found, forth, back;
  field.ask(at, found);
  FeatureRows inputs(1, 11);
  inputs << (bones.linear * at.row(0).transpose().cast<float>() + bones.offset).transpose(), 0.3f, -1.2f;
  CHECK(found[0].value == Approx(evaluate(network, inputs)(0, 0)).epsilon(1e-5));
  for (int k = 0; k < 3; ++k) {
    Points moved = at;
    moved(0, k) += 1e-2;
    field.ask(moved, forth);
    moved(0, k) -= 2e-2;
    field.ask(moved, back);
    CHECK(found[0].gradient[k] == Approx((forth[0].value - back[0].value) / 2e-2).margin(2e-3));
  }
  CHECK_THROWS_AS(NeuralDistance(network, point_query(), condition), Error);
  CHECK(forward_operations(make_neural_distance({}, 1), 9723) == Approx(165e9).epsilon(0.01));
}

}  // namespace selvedge::test_neural_distance
