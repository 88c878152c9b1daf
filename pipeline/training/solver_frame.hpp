#pragma once

#include <memory>

#include "pipeline/training/rolling_state.hpp"

namespace selvedge {

// The frame that a state is about to make, as the solver takes it: in m/s, and without memory of earlier frames.
struct SolverFrame {
  State from;
  Drive drive;
  double dt = 0;  // [s]
};
SolverFrame solver_frame(const RollingState&);

// What runs behind a network; null: nothing does. It parts tangled starts first. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_behind(const Scene&, BehindNetwork);

// Lets what runs behind the network, if something does, make the state's frame from the network's one. Returns false if
// it rejects the step.
bool pass_behind(RollingState&, NextCloth& next);

}  // namespace selvedge
