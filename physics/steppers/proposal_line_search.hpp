#pragma once

#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/contact_stage.hpp"

namespace selvedge {

// A line search toward a proposal, on the step's incremental potential with contacts of pairs that are near at the
// start.
struct ProposalLineSearch {
  // newton: number of iterations from free flight; the line begins where they end. 0: it begins at free flight.
  ProposalLineSearch(const Scene&, ImplicitEulerOptions, int newton);
  ProposalLineSearch(const ProposalLineSearch&) = delete;
  ProposalLineSearch& operator=(const ProposalLineSearch&) = delete;

  const Scene& scene;
  int newton;
  ImplicitEuler solver;
};

// Moves x to the least potential among `steps` points on the line from its beginning to x, which is the last point (the
// gate of training.md). If the potential is least at the beginning, x is set to it and the result is false.
bool search_along(ProposalLineSearch&, ContactStage&, const State& from, const Drive&, double dt, int steps, Points& x);

}  // namespace selvedge
