#pragma once

#include "physics/frame/frame_audits.hpp"

namespace selvedge {

// One frame: a step of the stepper by dt [s], the audit of its motion, the audit of the state that it made, and the
// verdict, in this order (judge_frame). A stop flag in the extras ends the audits too: the frame is then rejected as
// `stopped`.
StepReport make_frame(Stepper&, FrameAudits&, const State& from, const Drive&, double dt, State& to,
                      const StepExtras& = {});

}  // namespace selvedge
