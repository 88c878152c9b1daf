#pragma once

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// The result of a stepper's step.
struct StepEnd {
  Points x, v;                           // of the cloth [m], [m/s]
  std::vector<Points> obstacles;         // where they ended
  std::vector<MemoryBlock> memory = {};  // for its next step
};

// The common end of every step: accepts it and fills in `to` as the contract in stepper.hpp says. Sets the lag of
// obstacles in the report and, if the stepper has set no path, the straight path to the end. A lag within rounding
// counts as none.
void finish_step(const State& from, const Drive&, double dt, StepEnd, State& to, StepReport&);

}  // namespace selvedge
