#include "pipeline/shapes/motion.hpp"

#include <algorithm>
#include <cassert>

namespace selvedge {
namespace {

constexpr double nearly_opposite = 1e-12;  // directions whose cosine is nearer to -1 have no defined axis

// A unit vector perpendicular to both, which may be parallel.
Vec3 perpendicular(const Vec3& a, const Vec3& b) {
  Eigen::Matrix<double, 3, 2> both;
  both << a, b;
  const Eigen::ColPivHouseholderQR<decltype(both)> factors(both / both.cwiseAbs().maxCoeff());
  return factors.householderQ() * Vec3::UnitZ();
}

double between(const std::vector<double>& times, const std::vector<Vec3>& values, std::size_t k, int axis) {
  return (values[k + 1][axis] - values[k][axis]) / (times[k + 1] - times[k]);
}

// Slope at key k that keeps every piece monotone: the weighted harmonic mean of the neighbouring secants if they agree
// in sign, else zero.
double slope(const std::vector<double>& times, const std::vector<Vec3>& values, std::size_t k, int axis) {
  if (k == 0 || k + 1 == times.size()) return 0;
  const double before = between(times, values, k - 1, axis), after = between(times, values, k, axis);
  if (before * after <= 0) return 0;
  const double left = times[k] - times[k - 1], right = times[k + 1] - times[k];
  return 3 * (left + right) / ((2 * right + left) / before + (right + 2 * left) / after);
}

Vec3 cubic(const std::vector<double>& times, const std::vector<Vec3>& values, std::size_t k, double s) {
  const double h = times[k + 1] - times[k];
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = values[k][axis], b = values[k + 1][axis];
    const double from = h * slope(times, values, k, axis), to = h * slope(times, values, k + 1, axis);
    result[axis] = a + s * (from + s * ((3 * (b - a) - 2 * from - to) + s * (from + to - 2 * (b - a))));
  }
  return result;
}

}  // namespace

Vec3 keyed_vector(const std::vector<double>& times, const std::vector<Vec3>& values, Interpolation interpolation,
                  double time) {
  assert(!times.empty() && times.size() == values.size());
  if (time <= times.front()) return values.front();
  if (time >= times.back()) return values.back();
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto k = static_cast<std::size_t>(after - times.begin()) - 1;
  const double s = (time - times[k]) / (times[k + 1] - times[k]);
  if (interpolation == Interpolation::smooth) return cubic(times, values, k, s);
  return values[k] + s * (values[k + 1] - values[k]);
}

Pose pose_at(const Motion& motion, double time) {
  if (motion.keys.empty()) return {};
  std::vector<double> times;
  std::vector<Vec3> translations, rotations;
  for (const Keyframe& key : motion.keys) {
    times.push_back(key.time);
    translations.push_back(key.translation);
    rotations.push_back(key.rotation);
  }
  return {keyed_vector(times, translations, motion.interpolation, time),
          keyed_vector(times, rotations, motion.interpolation, time)};
}

Mat3 rotation_matrix(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Vec3 rotation_vector(const Mat3& rotation) {
  const Eigen::AngleAxisd turn(rotation);  // through a quaternion: exact near 0 and pi
  return turn.angle() * turn.axis();
}

Mat3 rotation_between(const Vec3& a, const Vec3& b) {
  const Vec3 from = a.normalized(), to = b.normalized();
  const double cosine = std::max(to.dot(from), -1.0);
  Eigen::Quaterniond turn;
  if (cosine < -1 + nearly_opposite) {
    const double half = (1 + cosine) / 2;  // the square of the cosine of half the angle
    turn.w() = std::sqrt(half);
    turn.vec() = std::sqrt(1 - half) * perpendicular(from, to);
  } else {
    const double twice = std::sqrt(2 * (1 + cosine));
    turn.w() = twice / 2;
    turn.vec() = from.cross(to) / twice;
  }
  return turn.toRotationMatrix();
}

Points moved(const Motion& motion, const Points& x, double time) {
  const Pose pose = pose_at(motion, time);
  Points result = x;
  if (!pose.rotation.isZero(0)) {
    const Mat3 turn = rotation_matrix(pose.rotation);
    result = ((x.rowwise() - motion.center.transpose()) * turn.transpose()).rowwise() + motion.center.transpose();
  }
  if (!pose.translation.isZero(0)) result.rowwise() += pose.translation.transpose();
  return result;
}

bool is_still(const Motion& motion) {
  return std::all_of(motion.keys.begin(), motion.keys.end(), [&](const Keyframe& key) {
    return key.translation == motion.keys.front().translation && key.rotation == motion.keys.front().rotation;
  });
}

}  // namespace selvedge
