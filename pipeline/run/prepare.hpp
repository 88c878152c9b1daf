#pragma once

#include <functional>

#include "pipeline/run/progress.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// Steps a scene whose time begins before 0 to time 0, with the default conventional stepper, so that all steppers start
// from the same bits. Records nothing; Setup's `prepared` says what was done. Does nothing if time begins at 0. Returns
// false if stopped. Throws Error if a step is rejected.
bool prepare(Setup&, const std::function<bool()>& stop = {}, Progress* progress = nullptr,
             const StopFlag& interrupt = {});

}  // namespace selvedge
