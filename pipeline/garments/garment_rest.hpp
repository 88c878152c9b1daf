#pragma once

#include "collision/geometry/points.hpp"

namespace selvedge {

// When a garment counts as at rest: fewer of its vertices than `resting_share` are faster than `resting_speed`.
inline constexpr double resting_speed = 0.009;  // [m/s]
inline constexpr double resting_share = 0.015;

// The share of vertices faster than resting_speed. way: displacements [m] in `time` [s].
inline double moving_share(const Points& way, double time) {
  const Eigen::VectorXd moved = way.rowwise().norm();
  return static_cast<double>((moved.array() > resting_speed * time).count()) / static_cast<double>(moved.size());
}

}  // namespace selvedge
