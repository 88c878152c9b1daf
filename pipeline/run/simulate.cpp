#include "pipeline/run/simulate.hpp"

#include <utility>

#include "collision/geometry/stop_scope.hpp"
#include "pipeline/run/frames_ahead.hpp"

namespace selvedge {

StepReport simulate(const Scene& scene, Stepper& stepper, const std::function<Drive(double)>& drive_at, double dt,
                    int frames, State& state, const FrameSink& sink, const StopFlag& stop) {
  FramesAhead ahead(scene, stepper, drive_at, dt, frames, state, stop);
  const StopFlag never;
  StepReport last;
  while (std::optional<MadeFrame> made = ahead.next()) {
    last = std::move(made->report);
    if (last.reason == Reason::stopped) break;
    const bool accepted = last.status == StepStatus::accepted;
    if (accepted) std::swap(state, made->state);
    const StopScope uninterrupted(never);  // while the sink works on a frame
    if (!sink({state, made->drive, last, made->seconds}) || !accepted) break;
  }
  return last;
}

}  // namespace selvedge
