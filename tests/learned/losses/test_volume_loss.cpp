#include <catch2/catch.hpp>

#include "learned/losses/volume_loss.hpp"
#include "tests/collision/penetration/closed_shapes.hpp"

namespace selvedge::test_volume_loss {

using namespace closed;

namespace {

Solid two_balls() {
  return both(turned(ball(1), Vec3(1, 2, 3), 0.4), moved(turned(ball(1), Vec3(3, 1, 2), 0.7), Vec3(1.4, 0.1, 0.2)));
}

Points some_direction(const Points& x) {
  Points direction = x;
  for (int v = 0; v < x.rows(); ++v) direction.row(v) << std::sin(3.0 * v), std::cos(5.0 * v), std::sin(7.0 * v + 1);
  return direction / direction.norm();
}

// The gradient is that of the value, and is added.
template <class Loss>
void check_gradient(const Points& x, double h, const Loss& loss) {
  const Points direction = some_direction(x);
  Points gradient = Points::Constant(x.rows(), 3, 2);
  const double value = loss(x, &gradient);
  CHECK(value > 0);
  CHECK(loss(x, nullptr) == value);
  gradient.array() -= 2;
  const double slope = (loss(x + h * direction, nullptr) - loss(x - h * direction, nullptr)) / (2 * h);
  CHECK(gradient.cwiseProduct(direction).sum() == Approx(slope).epsilon(1e-5).margin(1e-8 * gradient.norm()));
}

}  // namespace

TEST_CASE("volume loss: value, gradient and counts", "[learned]") {
  const Solid solid = two_balls();
  const ClosedSurface closed = close_surface(solid.surface());
  check_gradient(solid.x, 1e-5, [&](const Points& x, Points* g) { return volume_loss(closed, {}, x, g); });
  VolumeCounts counts;
  const double value = volume_loss(closed, {}, solid.x, nullptr, &counts);
  CHECK(value == Approx(6 * counts.volume));
  CHECK(counts.contours == 1);
  CHECK(counts.enclosed == 1);
  // Between garments the winding form is the same; within one, where these are two parts of it, it is close.
  VolumeLoss winding;
  winding.form = VolumeForm::winding;
  CHECK(volume_loss(closed, winding, solid.x, nullptr) == Approx(value));
  const std::vector<int> one(static_cast<std::size_t>(solid.x.rows()), 0);
  CHECK(volume_loss(close_surface(solid.surface(), one), winding, solid.x, nullptr) == Approx(value).epsilon(0.03));

  VolumeLoss bounded;
  bounded.saturation = counts.volume / 3;
  check_gradient(solid.x, 1e-5, [&](const Points& x, Points* g) { return volume_loss(closed, bounded, x, g); });
  CHECK(volume_loss(closed, bounded, solid.x, nullptr) == Approx(value / 3 * (1 + std::log(3.0))));

  Points undefined = solid.x;
  undefined(3, 1) = std::nan("");
  CHECK(volume_loss(closed, {}, undefined, nullptr) == 0);
}

TEST_CASE("volume loss: descent parts two balls", "[learned]") {
  const Solid solid = two_balls();
  const ClosedSurface closed = close_surface(solid.surface());
  Points x = solid.x;
  const double before = volume_loss(closed, {}, x, nullptr);
  for (int i = 0; i < 30; ++i) {
    Points gradient = Points::Zero(x.rows(), 3);
    volume_loss(closed, {}, x, &gradient);
    x -= 0.05 * gradient;
  }
  CHECK(volume_loss(closed, {}, x, nullptr) < 0.3 * before);
}

TEST_CASE("volume loss: forces and the repulsion of vertices", "[learned]") {
  const Solid solid = two_balls();
  const std::vector<double> mass(static_cast<std::size_t>(solid.x.rows()), 0.25);
  Points down = Points::Zero(solid.x.rows(), 3);
  down.col(1).setConstant(-9.81);
  Points gradient = Points::Zero(solid.x.rows(), 3);
  CHECK(force_loss(mass, down, solid.x, &gradient) == Approx(0.25 * 9.81 * solid.x.col(1).sum()));
  CHECK(gradient.col(1).isConstant(0.25 * 9.81, 1e-12));
  CHECK(gradient.col(0).isZero(0));
  for (const int power : {1, 2})
    check_gradient(solid.x, 1e-7, [&](const Points& x, Points* g) {
      return vertex_repulsion_loss(solid.surface(), 0.7, power, x, g);
    });
}

}  // namespace selvedge::test_volume_loss
