#pragma once

#include <span>

#include "physics/energies/lane_block.hpp"
#include "physics/energies/membrane_element.hpp"
#include "physics/scene/scene.hpp"

namespace selvedge {

// Several triangles of one model side by side, a lane each, so that the same arithmetic goes over them in wide
// registers.
struct MembraneLanes {
  static constexpr int width = 16;
  using Lane = double[width];

  int count = 0;  // of lanes in use
  // The edges x1 - x0 and x2 - x0 in space, the inverse of the rest edges by rows, rest area, Lame's mu and lambda.
  Lane edge[6], inverse[4], area, mu, lambda;

  // Second stage, for derivatives: with F = a a0^T + b b0^T, a0 and b0 orthonormal axes of the rest plane that the
  // model chooses, psi is a function of the vectors a and b. d psi / da, d psi / db, the second derivatives aa and bb
  // (xx xy xz yy yz zz) and ab (by rows) [N/m].
  Lane axis_a[2], axis_b[2], stress_a[3], stress_b[3], aa[6], bb[6], ab[9];

  Lane energy;       // [J]
  Lane force[6];     // gradient at corners 1 and 2; that at corner 0 is minus their sum [N]
  Lane block[3][9];  // Hessian between corners (0, 1), (0, 2) and (1, 2), by rows [N/m]
};

// How many of the first elements, at least one, go into lanes together. Materials are those of the cloths.
int together(std::span<const Material> materials, std::span<const MembraneElement> elements);

// Writes `energy`, or `force` and `block`, of elements that go together. Without `hessian` no block is written. With
// `psd` the Hessian is projected to PSD in closed form.
void membrane_energies(std::span<const Material>, std::span<const MembraneElement>, const Points& x, MembraneLanes&);
void membrane_derivatives(std::span<const Material>, std::span<const MembraneElement>, const Points& x, bool hessian,
                          bool psd, MembraneLanes&);

// The part of these two that isotropic models compute, from the edges: energies, or all of the second stage. Without
// `hessian` no second derivative is written.
void isotropic_energies(MembraneModel, MembraneLanes&);
void isotropic_densities(MembraneModel, bool hessian, bool psd, MembraneLanes&);

}  // namespace selvedge
