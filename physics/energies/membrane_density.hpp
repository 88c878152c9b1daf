#pragma once

#include "physics/energies/membrane_element.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Energy density psi(F) of a membrane [J/m2] and its derivatives, along two orthonormal axes of the rest plane chosen
// by the model. With F = a a0^T + b b0^T, a0 and b0 the columns of `axes`, psi is a function of the vectors a and b.
struct MembraneDensity {
  Eigen::Matrix2d axes;
  Vec3 stress_a, stress_b;                  // d psi / da, d psi / db [N/m]
  Mat3 hessian_aa, hessian_ab, hessian_bb;  // second derivatives; the ba block is the transpose of ab [N/m]
};

// With hessian = false the second derivatives are not written.
MembraneDensity baraff_witkin_density(const Material&, const Mat32& F, bool hessian, bool psd);
double baraff_witkin_energy(const Material&, const Mat32& F);

}  // namespace selvedge
