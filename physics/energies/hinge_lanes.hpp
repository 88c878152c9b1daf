#pragma once

#include <span>

#include "physics/energies/bending.hpp"
#include "physics/energies/lane_block.hpp"

namespace selvedge {

// Several hinges side by side, a lane each, so that the same arithmetic goes over them in wide registers. The energy is
// that of hinge_energy, but for rounding.
struct HingeLanes {
  static constexpr int width = 16;
  using Lane = double[width];

  int count = 0;  // of lanes in use
  // The edge e1 - e0, the tips a - e0 and b - e0; weight, rest angle, and 1 where the current length weighs, else 0.
  Lane edge[3], tip_a[3], tip_b[3], weight, rest_angle, current;

  Lane difference;  // of the angle to the one at rest, in [-pi, pi]
  Lane energy;      // [J]
  Lane force[12];   // gradient in the order of Hinge::nodes [N]
  // Hessian between the nodes (0, 1), (0, 2), (0, 3), (1, 2), (1, 3) and (2, 3), by rows [N/m]. A translation
  // changes no force, so that a node's own block is minus the sum of its row.
  static constexpr int pairs = 6;
  Lane block[pairs][9];
};

// Loads the first hinges, as many as fit, and writes `energy` and, with `gradient`, `force`.
void hinge_energies(std::span<const Hinge>, const Points& x, bool gradient, HingeLanes&);

// Writes `block` of the hinges that are loaded: exact, or with `psd` a closed-form PSD bound. The bound is the
// Gauss-Newton part plus the clamped second derivative of the angle, triangle by triangle; with the current length a
// part for the edge's own stretching is added. Derivatives are zero where a triangle is degenerate. For slivers (height
// below 1e-4 of the edge) they are bounded and not exact.
void hinge_hessians(bool psd, HingeLanes&);

// The sum of the hinges' energies [J].
double hinge_energy(std::span<const Hinge>, const Points& x);

}  // namespace selvedge
