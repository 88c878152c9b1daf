#pragma once

#include <chrono>
#include <functional>

#include "physics/scene/stepper.hpp"

namespace selvedge {

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A frame as a sink sees it. After a rejected step `state` is still the last accepted one.
struct FrameEvent {
  const State& state;
  const Drive& drive;
  const StepReport& report;
  Clock::time_point started;  // when the work on this frame began
};
using FrameSink = std::function<bool(const FrameEvent&)>;  // false ends the run

// Steps `state` to frame `frames`, or until a step is rejected or the sink ends the run. Returns the last report
// (not_run where there was nothing to do). `state` ends as the last accepted one. A step that `stop` ended (see
// StepExtras) ends the run unseen by the sink.
StepReport simulate(Stepper&, const std::function<Drive(double time)>& drive_at, double dt, int frames, State& state,
                    const FrameSink&, const StopFlag& stop = {});

}  // namespace selvedge
