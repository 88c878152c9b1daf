#pragma once

#include "physics/frame/make_frame.hpp"

namespace selvedge::testing {

// A frame as a run makes it, without the memory of audits.
inline StepReport frame(const Scene& scene, Stepper& stepper, const State& from, const Drive& drive, double dt,
                        State& to, const StepExtras& extras = {}) {
  FrameAudits audits(scene);
  return make_frame(stepper, audits, from, drive, dt, to, extras);
}

}  // namespace selvedge::testing
