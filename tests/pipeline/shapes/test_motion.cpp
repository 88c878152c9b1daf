#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "pipeline/shapes/motion.hpp"

namespace selvedge::test_motion {

namespace {

const double pi = std::numbers::pi;

Motion two_keys(Interpolation interpolation) {
  return {{{1, Vec3(0, 0, 0), Vec3(0, 0, 0)}, {3, Vec3(2, 0, -4), Vec3(0, 4 * pi, 0)}}, interpolation, Vec3(1, 0, 0)};
}

}  // namespace

TEST_CASE("Linear motion passes its keys and is held outside", "[motion]") {
  const Motion motion = two_keys(Interpolation::linear);
  CHECK(pose_at(motion, 0).translation.isZero());
  CHECK(pose_at(motion, 1).translation.isZero());
  CHECK(pose_at(motion, 2).translation.isApprox(Vec3(1, 0, -2)));
  CHECK(pose_at(motion, 3).translation == Vec3(2, 0, -4));
  CHECK(pose_at(motion, 9).translation == Vec3(2, 0, -4));
  // More than a whole turn.
  CHECK(pose_at(motion, 2).rotation.isApprox(Vec3(0, 2 * pi, 0)));
}

TEST_CASE("Points turn about the centre, then move", "[motion]") {
  const Motion motion{{{0, Vec3(0, 1, 0), Vec3(0, pi / 2, 0)}}, Interpolation::linear, Vec3(1, 0, 0)};
  Points x(2, 3);
  x << 1, 0, 0, 2, 0, 0;
  Points expected(2, 3);
  expected << 1, 1, 0, 1, 1, -1;  // x turns to -z about y
  CHECK(moved(motion, x, 5).isApprox(expected, 1e-14));
  CHECK(moved(Motion{}, x, 5) == x);
}

TEST_CASE("Smooth motion is C1, at rest at its ends, and does not overshoot", "[motion]") {
  const std::vector<double> times{0, 1, 1.5, 3, 4};
  const std::vector<Vec3> values{{0, 0, 0}, {1, 1, 5}, {1.2, 0, 5}, {4, 2, 5}, {4, 2, 0}};
  const auto at = [&](double t) { return keyed_vector(times, values, Interpolation::smooth, t); };
  for (std::size_t k = 0; k < times.size(); ++k) CHECK((at(times[k]) - values[k]).norm() < 1e-14);
  const double e = 1e-6;
  for (const double t : times) CHECK(((at(t + e) - at(t)) / e - (at(t) - at(t - e)) / e).norm() < 1e-3);
  CHECK((at(e) - at(0)).norm() / e < 1e-3);
  CHECK((at(4) - at(4 - e)).norm() / e < 1e-3);
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    for (double s = 0; s <= 1; s += 0.01) {
      const Vec3 p = at(times[k] + s * (times[k + 1] - times[k]));
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(p[axis] >= std::min(values[k][axis], values[k + 1][axis]) - 1e-14);
        CHECK(p[axis] <= std::max(values[k][axis], values[k + 1][axis]) + 1e-14);
      }
    }
}

TEST_CASE("Only a change of pose is motion", "[motion]") {
  CHECK(is_still({}));
  CHECK(is_still({{{0, Vec3(1, 0, 0), Vec3(0, 0, 0)}, {1, Vec3(1, 0, 0), Vec3(0, 0, 0)}}, {}, {}}));
  CHECK_FALSE(is_still(two_keys(Interpolation::smooth)));
}

TEST_CASE("The rotation between two directions is the shortest, and defined where they are opposite", "[motion]") {
  const Vec3 a(1, -2, 0.5), b(0.3, 1, 4);
  const auto check = [](const Vec3& from, const Vec3& to, double angle) {
    const Mat3 turn = rotation_between(from, to);
    CHECK((turn * turn.transpose() - Mat3::Identity()).norm() < 1e-12);
    CHECK(turn.determinant() == Approx(1));
    CHECK((turn * from.normalized() - to.normalized()).norm() < 1e-12);
    CHECK(rotation_vector(turn).norm() == Approx(angle).margin(1e-12));
  };
  check(a, b, std::acos(a.normalized().dot(b.normalized())));
  check(a, 3 * a, 0);
  check(a, -2 * a, std::numbers::pi);
  for (int axis = 0; axis < 3; ++axis) check(Vec3::Unit(axis), -Vec3::Unit(axis), std::numbers::pi);
}

}  // namespace selvedge::test_motion
