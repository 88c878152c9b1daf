#pragma once

#include "physics/steppers/step_audit.hpp"

namespace selvedge {

// What a stepper has made of a step.
struct StepEnd {
  Points x, v;                           // of the cloth [m], [m/s]
  std::vector<Points> obstacles;         // where they ended
  std::vector<MemoryBlock> memory = {};  // for its next step
};

// The common end of every stepper: accepts the step, fills `to` as the contract in stepper.hpp asks for, and the report
// with the lag of obstacles and with the audit of positions, which it leaves to `later` where that is given. A lag
// within rounding counts as none. A step whose audit meets more pairs than it may look at is rejected.
void finish_step(const Scene&, const State& from, const Drive&, double dt, StepEnd, AuditMemory&, State& to,
                 StepReport&, LaterAudits* later = nullptr);

}  // namespace selvedge
