#pragma once

#include "physics/scene/stepper.hpp"

namespace selvedge {

// When a hybrid stepper asks for the next proposal. After a refusal the parent steps alone for some steps. Each
// refusal doubles the next wait; `to_halve` admitted proposals in a row halve it.
struct ProposalTrust {
  int wait = 0;       // steps until a proposal is asked for
  int next_wait = 1;  // after a refusal
  int admitted = 0;   // in a row since `next_wait` has changed
};

// Kept in State::memory. False if no hybrid stepper made the state; `trust` then stays as it was.
bool read_trust(const State&, ProposalTrust& trust);
void remember(const ProposalTrust&, State&);

// After a step without a proposal, with an admitted one, and with a refused one.
ProposalTrust after_wait(ProposalTrust);
ProposalTrust after_admission(ProposalTrust, int to_halve);
ProposalTrust after_refusal(ProposalTrust, int longest_wait);

}  // namespace selvedge
