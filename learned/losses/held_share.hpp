#pragma once

#include "learned/losses/objective.hpp"

namespace selvedge {

// As add_losses, with the contours' term scaled so that it has ContourLoss::share of the sample's gradient: its norm
// over the inverse masses is share / (1 - share) of that of all other terms together. Terms are returned as they are
// scaled. Without a share, without crossings, or where a norm is zero, the same as add_losses.
std::vector<LossTerm> add_losses_with_share(const LossInputs&, const LossOptions&, LossSearch&, Points& gradient);

}  // namespace selvedge
