#pragma once

#include "learned/losses/force_input.hpp"

namespace selvedge {

// The force that networks with force inputs are shown, in training and roll-outs alike: what the energies and a soft
// contact with the body ask for at inputs.predicted, the guess; with the inertia from the second pass on, for the first
// one's guess has none. `contour_weight` [N/m]: of the part that shortens intersection contours; 0: there is none.
Points shown_force(const LossInputs&, int pass, double contour_weight, LossSearch&);

}  // namespace selvedge
