#pragma once

#include <functional>

#include "pipeline/run/progress.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// Brings a scene whose time begins before 0 to time 0, with the conventional stepper as it is by default: whatever
// steps the scene from there on starts from the same bits. Nothing is recorded; `prepared` says what was done. Does
// nothing where time begins at 0. False: stopped. Throws Error where a step is rejected.
bool prepare(Setup&, const std::function<bool()>& stop = {}, Progress* progress = nullptr,
             const StopFlag& interrupt = {});

}  // namespace selvedge
