#include <catch2/catch.hpp>

#include "tests/learned/loss_scenes.hpp"

// The loss of docs/extending.md.
namespace selvedge::test_added_loss {

// Depth below the ground y = 0: the sum of max(-y, 0)^2 / 2 [m2].
double ground_loss(const LossFrame& frame, Points* gradient) {
  double sum = 0;
  for (Eigen::Index v = 0; v < frame.x.rows(); ++v) {
    const double depth = std::max(-frame.x(v, 1), 0.0);
    sum += depth * depth / 2;
    if (gradient) (*gradient)(v, 1) -= depth;
  }
  return sum;
}

// A weight [N/m] that begins after a fifth of the run. In the program it is a member of LossOptions.
const LossRamp& ground_weight(const LossOptions&) {
  static const LossRamp ramp{0, 1e3, 0.2, 0.3};
  return ramp;
}

constexpr LossRow ground{"ground", "ground", "depth below the ground", ground_weight, nullptr, ground_loss};

TEST_CASE("extending: an added loss has the gradient of its value", "[losses]") {
  testing::LossScene scene;
  scene.predicted.col(1).array() -= 0.01;
  const LossInputs in = scene.inputs();
  const LossOptions options;
  const LossMatches matches;
  Points gradient = Points::Zero(scene.x.rows(), 3);
  const double value = ground.value({in, options, matches}, &gradient);
  CHECK(value > 0);
  CHECK(gradient.minCoeff() < 0);
  CHECK(ground.weight(options).to == 1e3);
  const double step = 1e-6;
  const Points moved = scene.predicted + step * gradient / gradient.norm();
  LossInputs there = in;
  there.predicted = &moved;
  CHECK((ground.value({there, options, matches}, nullptr) - value) / step == Approx(gradient.norm()).epsilon(1e-3));
}

}  // namespace selvedge::test_added_loss
