#pragma once

#include "physics/steppers/conventional_stepper.hpp"

namespace selvedge {

// The same options for one rough solve a frame and then the response to contact, as `run.quality: draft` solves.
ConventionalOptions one_rough_solve(ConventionalOptions);

}  // namespace selvedge
