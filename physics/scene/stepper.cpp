#include "physics/scene/stepper.hpp"

#include <cmath>

namespace selvedge {

bool StepperTraits::accepts(double dt) const { return dt > 0 && (!only_dt || std::abs(dt - *only_dt) <= 1e-9); }

}  // namespace selvedge
