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
  double seconds;  // by the clock: of its step, and of waiting for its drive and its audits
};
using FrameSink = std::function<bool(const FrameEvent&)>;  // false ends the run

// Steps `state` to frame `frames`, or until a step is rejected or the sink ends the run. Returns the last report
// (not_run where there was nothing to do). `state` ends as the last accepted one. A step that `stop` ended (see
// StepExtras) ends the run unseen by the sink.
//
// Where there are two threads or more, one of them may make the drive of the next frame and the audits of the last one
// (StepExtras::later) beside a step, if that is faster (arrangement.hpp). The sink sees the same frames, bit for bit:
// it is given a frame with its verdict only. Where that is bad, the frame is stepped again with its audits in the step,
// and what was made after it is void. Phases of a frame then have the time that it waited for its audits. `drive_at` is
// called by one thread at a time, and never while the sink is.
StepReport simulate(Stepper&, const std::function<Drive(double time)>& drive_at, double dt, int frames, State& state,
                    const FrameSink&, const StopFlag& stop = {});

}  // namespace selvedge
