#include "pipeline/run/simulate.hpp"

#include <utility>

namespace selvedge {

StepReport simulate(Stepper& stepper, const std::function<Drive(double)>& drive_at, double dt, int frames, State& state,
                    const FrameSink& sink, const StopFlag& stop) {
  StepReport report;
  State next;
  while (state.frame < frames) {
    const Clock::time_point started = Clock::now();
    const Drive drive = drive_at(state.time + dt);
    report = stepper.step(state, drive, dt, next, {.stop = stop});
    if (report.reason == Reason::stopped) break;
    const bool accepted = report.status == StepStatus::accepted;
    if (accepted) std::swap(state, next);
    if (!sink({state, drive, report, started}) || !accepted) break;
  }
  return report;
}

}  // namespace selvedge
