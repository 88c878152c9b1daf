#pragma once

#include <array>

#include <Eigen/Core>

namespace selvedge {

using Mat32 = Eigen::Matrix<double, 3, 2>;

// One constant-strain triangle: F = [x1 - x0, x2 - x0] * inverse maps its flat rest shape into space.
struct MembraneElement {
  std::array<int, 3> nodes;
  Eigen::Matrix2d inverse;  // of the rest edge matrix [1/m]
  double area = 0;          // rest area [m2]
  int material = 0;         // index of the cloth
  int triangle = 0;         // index in the scene's surface
};

}  // namespace selvedge
