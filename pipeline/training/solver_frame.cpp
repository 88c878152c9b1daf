#include "pipeline/training/solver_frame.hpp"

#include <utility>

#include "learned/steppers/learned_state.hpp"
#include "physics/steppers/conventional_stepper.hpp"
#include "physics/steppers/one_rough_solve.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "physics/steppers/response_stepper.hpp"
#include "pipeline/training/simulate_frames.hpp"

namespace selvedge {

SolverFrame solver_frame(const RollingState& state) {
  const Scene& scene = state.roll.scene->scene;
  SolverFrame frame;
  frame.dt = state.now.timestep;
  frame.from.x = state.now.x;
  frame.from.v = state.now.velocity / learned_dt;
  if (!scene.obstacles.empty()) frame.from.obstacles = {state.now.body};
  frame.drive = drive_to(scene, state.roll.forces, state.now.body_target, state.now.target);
  return frame;
}

std::unique_ptr<Stepper> make_behind(const Scene& scene, BehindNetwork behind) {
  if (behind == BehindNetwork::nothing) return nullptr;
  return make_recovering_stepper(scene, behind == BehindNetwork::response
                                            ? make_response_stepper(scene)
                                            : make_conventional_stepper(scene, one_rough_solve({})));
}

bool pass_behind(RollingState& state, NextCloth& next) {
  if (!state.behind) return true;
  const SolverFrame frame = solver_frame(state);
  StepExtras extras;
  extras.guess = &next.x;
  State to;
  if (state.behind->step(frame.from, frame.drive, frame.dt, to, extras).status != StepStatus::accepted) return false;
  next.velocity += to.x - next.x;
  next.x = std::move(to.x);
  return true;
}

}  // namespace selvedge
