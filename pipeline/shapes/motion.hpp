#pragma once

#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

struct Keyframe {
  double time = 0;                  // [s]
  Vec3 translation = Vec3::Zero();  // [m]
  Vec3 rotation = Vec3::Zero();     // rotation vector: axis times angle [rad]; more than one turn is allowed
};

// Interpolation of translation and rotation vector between keys. `smooth` is C1, does not overshoot, and is at rest at
// the first and the last key (monotone cubics of Fritsch and Carlson 1980). Held before the first and after the last
// key.
enum class Interpolation { linear, smooth };

struct Motion {
  std::vector<Keyframe> keys;  // ascending times; none: at rest
  Interpolation interpolation = Interpolation::linear;
  Vec3 center = Vec3::Zero();  // of rotation, moves with the translation
};

struct Pose {
  Vec3 translation = Vec3::Zero();
  Vec3 rotation = Vec3::Zero();
};

Pose pose_at(const Motion&, double time);
Points moved(const Motion&, const Points&, double time);
bool is_still(const Motion&);

// A keyframed vector, such as wind.
Vec3 keyed_vector(const std::vector<double>& times, const std::vector<Vec3>& values, Interpolation, double time);

Mat3 rotation_matrix(const Vec3& rotation_vector);

// The rotation vector of a rotation, no longer than pi.
Vec3 rotation_vector(const Mat3&);

// The shortest rotation that takes the direction of a to that of b; neither may be 0. If they are opposite, the axis is
// any direction perpendicular to a.
Mat3 rotation_between(const Vec3& a, const Vec3& b);

}  // namespace selvedge
