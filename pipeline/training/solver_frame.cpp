#include "pipeline/training/solver_frame.hpp"

#include <utility>

#include "learned/steppers/learned_state.hpp"
#include "physics/steppers/conventional_stepper.hpp"
#include "physics/steppers/recovering_stepper.hpp"
#include "physics/steppers/response_stepper.hpp"

namespace selvedge {
namespace {

// The drive toward a body and a skinned garment. Without a body nothing wears the garment.
Drive drive_to(const Scene& scene, const Drive& forces, const Points& body, const Points& cloth) {
  Drive drive = forces;
  drive.pins = cloth(scene.pins, Eigen::all);
  if (scene.obstacles.empty()) return drive;
  drive.skinned_targets = cloth;
  drive.obstacles = {body};
  return drive;
}

}  // namespace

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

bool simulate_frames(Stepper& solver, const Scene& scene, const Drive& forces, std::span<const SkinnedFrame> ends,
                     State& state) {
  for (const SkinnedFrame& end : ends) {
    State to;
    const Drive drive = drive_to(scene, forces, end.body.cast<double>(), end.cloth.cast<double>());
    if (solver.step(state, drive, learned_dt, to).status != StepStatus::accepted) return false;
    state = std::move(to);
  }
  return true;
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
