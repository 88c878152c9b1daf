#pragma once

#include <memory>

#include "physics/steppers/carried_guess.hpp"

namespace selvedge {

// The baseline that a learned stepper has to beat: the carried guess, then Bridson's response to contact. It solves
// nothing and ignores every elastic force; with the default model dressed cloth has no gravity either. A model with
// sets of vertices takes the whole scene, never a part of it. `name`: of the stepper, in reports. Keeps a reference to
// the scene.
std::unique_ptr<Stepper> make_carried_stepper(const Scene&, CarriedModel = {}, const char* name = "carried");

}  // namespace selvedge
