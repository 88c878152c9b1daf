#include "physics/frame/make_frame.hpp"

#include "physics/frame/bounded_step.hpp"

namespace selvedge {

StepReport make_frame(Stepper& stepper, FrameAudits& audits, const State& from, const Drive& drive, double dt,
                      State& to, const StepExtras& extras) {
  return bounded_step(stepper.traits().name, extras.stop, [&] {
    StepReport report = stepper.step(from, drive, dt, to, extras);
    to.clean = judge_frame(audits, from, drive, to, report);
    return report;
  });
}

}  // namespace selvedge
