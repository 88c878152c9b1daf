#include "pipeline/training/minimised.hpp"

#include "learned/losses/force_input.hpp"

namespace selvedge {

Minimised minimised(const FrameMaking& making, RollingState& state, const Points& start, int most_evaluations) {
  const TrainingScene& scene = *state.roll.scene;
  const SeenPositions seen = seen_positions(scene.rest, state.now, making.features);
  const auto evaluate = [&](const Points& x, Points& gradient) {
    gradient.setZero(x.rows(), 3);
    const double sum =
        sum_of(add_losses(inputs_of(state, seen, x, making.progress), making.losses, state.losses, &gradient));
    for (const int pin : scene.rest.pinned) gradient.row(pin).setZero();
    return sum;
  };
  const double dt = is_settling(state) ? making.losses.relaxation_dt : state.now.timestep;
  return minimised(evaluate, jacobi_diagonal(scene.losses, dt), start, most_evaluations);
}

}  // namespace selvedge
