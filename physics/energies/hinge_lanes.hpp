#pragma once

#include <span>

#include "physics/energies/bending.hpp"

namespace selvedge {

// Several hinges side by side, a lane each, so that the same arithmetic goes over them in wide registers. What
// hinge_energy and hinge_derivatives give for each of them, but for rounding.
struct HingeLanes {
  static constexpr int width = 16;
  using Lane = double[width];

  int count = 0;  // of lanes in use
  // The edge e1 - e0, the tips a - e0 and b - e0; weight, rest angle, and 1 where the current length weighs, else 0.
  Lane edge[3], tip_a[3], tip_b[3], weight, rest_angle, current;

  Lane energy;     // [J]
  Lane force[12];  // gradient in the order of Hinge::nodes [N]
};

// The first hinges, as many as fit: `energy`, and `force` where asked for.
void hinge_energies(std::span<const Hinge>, const Points& x, bool gradient, HingeLanes&);

}  // namespace selvedge
