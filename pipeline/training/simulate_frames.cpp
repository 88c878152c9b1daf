#include "pipeline/training/simulate_frames.hpp"

#include <utility>

#include "learned/steppers/learned_state.hpp"

namespace selvedge {

Drive drive_to(const Scene& scene, const Drive& forces, const Points& body, const Points& cloth) {
  Drive drive = forces;
  drive.pins = cloth(scene.pins, Eigen::all);
  if (scene.obstacles.empty()) return drive;
  drive.skinned_targets = cloth;
  drive.obstacles = {body};
  return drive;
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

}  // namespace selvedge
