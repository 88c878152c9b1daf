#pragma once

#include <chrono>
#include <functional>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A frame as a sink receives it. After a rejected step `state` is still the last accepted one.
struct FrameEvent {
  const State& state;
  const Drive& drive;
  const StepReport& report;
  double seconds;  // wall-clock time of its step, and of waiting for its drive and its audits
};
using FrameSink = std::function<bool(const FrameEvent&)>;  // false ends the run

// Makes frames from `state` to frame `frames`, or until one is rejected or the sink ends the run. Returns the last
// report (not_run where there was nothing to do). `state` ends as the last accepted one. A frame that `stop` ended (see
// StepExtras) ends the run and is not given to the sink. The sink gets the same frames on any number of threads, bit
// for bit, each with its verdict; frames_ahead.hpp says what overlaps. `drive_at` is called by one thread at a time,
// and never while the sink runs.
StepReport simulate(const Scene&, Stepper&, const std::function<Drive(double time)>& drive_at, double dt, int frames,
                    State& state, const FrameSink&, const StopFlag& stop = {});

}  // namespace selvedge
