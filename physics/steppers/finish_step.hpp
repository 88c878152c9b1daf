#pragma once

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// What a stepper has made of a step.
struct StepEnd {
  Points x, v;                           // of the cloth [m], [m/s]
  std::vector<Points> obstacles;         // where they ended
  std::vector<MemoryBlock> memory = {};  // for its next step
};

// The common end of every stepper: accepts the step, fills `to` as the contract in stepper.hpp asks for, and the report
// with the lag of obstacles and, where the stepper has named no path, with the straight one to the end. A lag within
// rounding counts as none.
void finish_step(const State& from, const Drive&, double dt, StepEnd, State& to, StepReport&);

}  // namespace selvedge
