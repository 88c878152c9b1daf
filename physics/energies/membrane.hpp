#pragma once

#include <span>
#include <vector>

#include "physics/scene/scene.hpp"

namespace selvedge {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;
using Mat32 = Eigen::Matrix<double, 3, 2>;

// One constant-strain triangle: F = [x1 - x0, x2 - x0] * inverse maps its flat rest shape into space.
struct MembraneElement {
  std::array<int, 3> nodes;
  Eigen::Matrix2d inverse;  // of the rest edge matrix [1/m]
  double area = 0;          // rest area [m2]
  int material = 0;         // index of the cloth
  int triangle = 0;         // index in the scene's surface
};

// Triangles of zero rest area carry no membrane energy and are left out.
std::vector<MembraneElement> membrane_elements(const Scene&);

Mat32 deformation_gradient(const MembraneElement&, const Points& x);

// Energy of one element [J] for the material's model: St. Venant-Kirchhoff, stable neo-Hookean on principal stretches,
// or Baraff-Witkin in its I5/I6 form (Kim 2020).
double membrane_energy(const Material&, MembraneElement, const Points& x);

// Energy of elements of cloths with these materials [J].
double membrane_energy(std::span<const Material>, std::span<const MembraneElement>, const Points& x);

// Gradient in the order x0 y0 z0 x1 y1 z1 x2 y2 z2 [N] and the Hessian projected to PSD in closed form [N/m];
// the unprojected Hessian with psd = false. Many elements are faster in lanes (membrane_lanes.hpp).
void membrane_derivatives(const Material&, MembraneElement, const Points& x, Vec9& gradient, Mat9* hessian,
                          bool psd = true);

}  // namespace selvedge
