#pragma once

#include <memory>
#include <optional>

#include "physics/scene/scene.hpp"
#include "physics/steppers/contact_stage.hpp"
#include "physics/steppers/finish_step.hpp"

namespace selvedge {

// The end of a step that goes straight to the proposal x [m], with Bridson's response to contact on the way. Absent
// where positions are not finite or the flag stops it: the report then says why it is rejected. `left_alone` may be
// null. Adds what the response did to the report.
std::optional<StepEnd> responded_end(ContactStage&, const State& from, const Drive&, double dt, Points x,
                                     const Exemption* left_alone, const StopFlag&, StepReport&);

// A stepper that goes straight to the guess of its extras, or without one where velocities take the cloth, and responds
// to contact on the way. It solves nothing, and honours the extras but for added terms. Keeps a reference to the scene.
std::unique_ptr<Stepper> make_response_stepper(const Scene&);

}  // namespace selvedge
