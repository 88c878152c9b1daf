#pragma once

#include "learned/losses/force_input.hpp"

namespace selvedge {

// The force that networks with force inputs are shown, in training and roll-outs alike: that of the energies and of a
// soft contact with the body at inputs.predicted, the guess. From the second pass on it includes inertia; the guess of
// the first pass has none. `contour_weight` [N/m]: of the part that shortens intersection contours; 0: there is none.
Points shown_force(const LossInputs&, int pass, double contour_weight, LossSearch&);

}  // namespace selvedge
