#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "collision/geometry/points.hpp"

namespace selvedge {

using Plane = Eigen::Hyperplane<double, 3>;

// A surface that a mesh may end at: what is kept has values below zero.
struct Border {
  std::function<double(const Vec3&)> value;  // about the distance [m]
  std::function<Vec3(const Vec3&)> onto;     // a point near the border, brought onto it
};

Border border(const Plane&);  // keeps the negative side
// Keeps what is outside of the lower half of an ellipsoid and of the tube that goes on above it.
Border border_round(const Vec3& centre, const Vec3& radii);

}  // namespace selvedge
