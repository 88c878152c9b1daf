#pragma once

#include <span>
#include <string>
#include <vector>

#include "learned/graph/graph_state.hpp"
#include "learned/graph/nearest_faces.hpp"
#include "learned/graph/seen_positions.hpp"
#include "learned/losses/loss_terms.hpp"

namespace selvedge {

// The inputs of the losses for a state of a graph. They refer to all arguments.
LossInputs loss_inputs(const LossGarment&, const GraphScene&, const GraphState&, const SeenPositions&,
                       const Points& predicted);

// Memory between calls. It saves time and changes nothing.
struct LossSearch {
  NearestFaces collision, before, after;
  ClothSearch cloth;
  LossMatches matches;
};

struct LossTerm {
  const LossRow* row = nullptr;
  std::string name;          // of the row
  double weight = 0;         // weight now, inside value and gradient
  double value = 0;          // [J]
  double gradient_norm = 0;  // norm over vertices that are not pinned [N]
};

// Adds to `gradient` (V x 3, may be null) the derivative of the weighted sum with respect to the predicted positions,
// and returns the terms of loss_rows() that have a weight, in their order. A term whose value or gradient is not finite
// is returned as it is and adds nothing. Throws Error where sizes do not fit.
std::vector<LossTerm> add_losses(const LossInputs&, const LossOptions&, LossSearch&, Points* gradient);

// The two parts of add_losses: the search for matches, and the sum for given matches (such as the authors' own).
void find_matches(const LossInputs&, const LossOptions&, LossSearch&);
std::vector<LossTerm> add_losses(const LossInputs&, const LossOptions&, const LossMatches&, Points* gradient);

double sum_of(std::span<const LossTerm>);  // [J]

// Works as add_losses, but scales the contours' term to ContourLoss::share of the sample's gradient: its norm over the
// inverse masses is share / (1 - share) of that of all other terms together. Returns the scaled terms. Without a share,
// without crossings, or where a norm is zero, it is the same as add_losses.
std::vector<LossTerm> add_losses_with_share(const LossInputs&, const LossOptions&, LossSearch&, Points& gradient);

// The sum at predicted = base + t (inputs.predicted - base) for each t. The gate of the fast recipe takes the least.
// Body faces are matched once, because they depend on where the cloth is now.
std::vector<double> losses_along(const LossInputs&, const LossOptions&, const Points& base, std::span<const double> t,
                                 LossSearch&);

}  // namespace selvedge
