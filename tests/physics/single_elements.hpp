#pragma once

#include "physics/energies/hinge_lanes.hpp"
#include "physics/energies/membrane.hpp"
#include "physics/energies/membrane_lanes.hpp"

// Energies and derivatives of one element alone, from lanes with nothing beside it.
namespace selvedge::single {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;
using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

// The Hessian from its blocks off the diagonal. Forces do not see a translation, so that a node's own block is minus
// the sum of its row.
template <class Lanes, class Matrix>
void fill_hessian(const Lanes& lanes, Matrix& hessian) {
  const int nodes = static_cast<int>(hessian.rows()) / 3;
  hessian.setZero();
  for (int i = 0, pair = 0; i < nodes; ++i)
    for (int j = i + 1; j < nodes; ++j, ++pair) {
      const Mat3 block = block_of(lanes, pair, 0);
      hessian.template block<3, 3>(3 * i, 3 * j) = block;
      hessian.template block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
  for (int i = 0; i < nodes; ++i) {
    Mat3 sum = Mat3::Zero();
    for (int j = 0; j < nodes; ++j)
      if (j != i) sum += hessian.template block<3, 3>(3 * i, 3 * j);
    hessian.template block<3, 3>(3 * i, 3 * i) = -0.5 * (sum + sum.transpose());
  }
}

// [J]
inline double membrane_energy(const Material& material, MembraneElement element, const Points& x) {
  MembraneLanes lanes;
  element.material = 0;
  membrane_energies({&material, 1}, {&element, 1}, x, lanes);
  return lanes.energy[0];
}

// The gradient x y z of each node in turn [N], and the Hessian [N/m] unless it is null.
inline void membrane_derivatives(const Material& material, MembraneElement element, const Points& x, Vec9& gradient,
                                 Mat9* hessian, bool psd = true) {
  MembraneLanes lanes;
  element.material = 0;
  selvedge::membrane_derivatives({&material, 1}, {&element, 1}, x, hessian != nullptr, psd, lanes);
  for (int k = 0; k < 6; ++k) gradient[3 + k] = lanes.force[k][0];
  gradient.head<3>() = -gradient.segment<3>(3) - gradient.tail<3>();
  if (hessian) fill_hessian(lanes, *hessian);
}

// The same of a hinge. Returns the energy [J].
inline double hinge_derivatives(const Hinge& hinge, const Points& x, Vec12& gradient, Mat12* hessian, bool psd = true) {
  HingeLanes lanes;
  hinge_energies({&hinge, 1}, x, true, lanes);
  for (int k = 0; k < 12; ++k) gradient[k] = lanes.force[k][0];
  if (!hessian) return lanes.energy[0];
  hinge_hessians(psd, lanes);
  fill_hessian(lanes, *hessian);
  return lanes.energy[0];
}

}  // namespace selvedge::single
