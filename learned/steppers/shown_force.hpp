#pragma once

#include "learned/losses/force_input.hpp"

namespace selvedge {

// The force that networks with force inputs see, in training and in roll-outs. It comes from the energies and a soft
// contact with the body at inputs.predicted, the guess. It includes inertia from the second pass on, because the first
// guess has none. `contour_weight` [N/m] weighs the part that shortens intersection contours; 0: none.
Points shown_force(const LossInputs&, int pass, double contour_weight, LossSearch&);

}  // namespace selvedge
