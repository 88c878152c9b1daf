#include "pipeline/run/prepare.hpp"

#include <fmt/format.h>

#include "collision/geometry/error.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "pipeline/garments/garment_rest.hpp"
#include "pipeline/run/simulate.hpp"

namespace selvedge {

std::optional<Start> prepare(const Setup& setup, const std::function<bool()>& stop, Progress* progress,
                             const StopFlag& interrupt) {
  Start start{setup.initial, setup.prepared};
  const int frames = -setup.initial.frame;
  if (frames <= 0) return start;
  const Clock::time_point started = Clock::now();
  const std::unique_ptr<Stepper> stepper =
      make_following_stepper(setup.scene, setup.followers, make_recovering_conventional_stepper(setup.scene));
  State& state = start.state;
  bool ended = false;
  if (progress) progress->begin(0, frames, "draping, frame");
  const FrameSink sink = [&](const FrameEvent& event) {
    if (progress) progress->frame(event.state.frame + frames);
    ended = stop && stop();
    return !ended;
  };
  const StepReport last = simulate(setup.scene, *stepper, setup.drive_at, 1 / setup.run.fps, 0, state, sink, interrupt);
  if (progress) progress->end();
  if (ended || last.reason == Reason::stopped) return {};
  if (last.status != StepStatus::accepted)
    throw Error(fmt::format("cannot be draped: a step is rejected {} frames before time 0", -state.frame),
                setup.file.string(), "let the body come more slowly (start.seconds), or start from: skinned");
  const Audit audit = last.audit.value_or(Audit{});
  const double moving = moving_share(state.v, 1);
  start.prepared = fmt::format("draped in {} frames, {}; {} pairs, {} vertices inside, fastest vertex {:.2g} m/s, {}",
                               frames, duration_text(seconds_since(started)), audit.intersecting_pairs(),
                               audit.inside_vertices, state.v.rowwise().norm().maxCoeff(),
                               moving < resting_share ? std::string("at rest")
                                                      : fmt::format("not at rest: {:.0f} % of the vertices are faster "
                                                                    "than {:g} mm/s",
                                                                    100 * moving, 1000 * resting_speed));
  state.time = 0;
  state.v = setup.velocity;
  state.memory.clear();
  return start;
}

}  // namespace selvedge
