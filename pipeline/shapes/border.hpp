#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "collision/geometry/points.hpp"

namespace selvedge {

using Plane = Eigen::Hyperplane<double, 3>;

// A surface at which a mesh may end. The side with negative values is kept.
struct Border {
  std::function<double(const Vec3&)> value;  // about the distance [m]
  std::function<Vec3(const Vec3&)> onto;     // moves a point near the border onto it
};

Border border(const Plane&);  // keeps the negative side
// Keeps the outside of the lower half of an ellipsoid and of the vertical tube above it.
Border border_round(const Vec3& centre, const Vec3& radii);

}  // namespace selvedge
