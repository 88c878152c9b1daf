#pragma once

#include "physics/scene/stepper.hpp"

namespace selvedge {

// When a hybrid stepper asks for the next proposal. After one that was refused the conventional stepper goes on alone
// for a stretch of steps. Each refusal doubles the next stretch; `to_halve` proposals in a row that are admitted halve
// it.
struct ProposalTrust {
  int wait = 0;      // steps until a proposal is asked for
  int stretch = 1;   // of the next wait
  int admitted = 0;  // in a row since `stretch` has changed
};

// Kept in State::memory. False: the state is not one that a hybrid stepper made, and `trust` is as it was.
bool read_trust(const State&, ProposalTrust& trust);
void remember(const ProposalTrust&, State&);

// After a step without a proposal, with an admitted one, and with a refused one.
ProposalTrust after_wait(ProposalTrust);
ProposalTrust after_admission(ProposalTrust, int to_halve);
ProposalTrust after_refusal(ProposalTrust, int longest_stretch);

}  // namespace selvedge
