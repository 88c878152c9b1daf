#pragma once

#include "learned/losses/objective.hpp"

namespace selvedge {

// Works as add_losses, but scales the contours' term to ContourLoss::share of the sample's gradient: its norm over the
// inverse masses is share / (1 - share) of that of all other terms together. Returns the scaled terms. Without a share,
// without crossings, or where a norm is zero, it is the same as add_losses.
std::vector<LossTerm> add_losses_with_share(const LossInputs&, const LossOptions&, LossSearch&, Points& gradient);

}  // namespace selvedge
