#pragma once

#include <cmath>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Solid angle of the triangle whose corners lie at a, b, c from the viewer, positive seen from behind: in [-2 pi, 2
// pi], at the ends on the triangle itself, where the sign means nothing (van Oosterom and Strackee 1983).
inline double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace selvedge
