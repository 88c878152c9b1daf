#pragma once

#include "physics/solve/implicit_euler.hpp"
#include "physics/steppers/contact_stage.hpp"

namespace selvedge {

// The step's incremental potential, with contacts of what is near at the start, along a proposal.
struct ProposalLineSearch {
  // newton: iterations that are taken from free flight, where the line begins; 0: it begins there.
  ProposalLineSearch(const Scene&, ImplicitEulerOptions, int newton);
  ProposalLineSearch(const ProposalLineSearch&) = delete;
  ProposalLineSearch& operator=(const ProposalLineSearch&) = delete;

  const Scene& scene;
  int newton;
  ImplicitEuler solver;
};

// Puts x where the potential is least of `steps` places on the way from the line's beginning to x, which is the last
// one (the gate of training.md). False, with x at the beginning: it is least there.
bool search_along(ProposalLineSearch&, ContactStage&, const State& from, const Drive&, double dt, int steps, Points& x);

}  // namespace selvedge
