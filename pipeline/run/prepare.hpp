#pragma once

#include <functional>
#include <optional>

#include "pipeline/run/progress.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// What a run starts from.
struct Start {
  State state;           // at time 0
  std::string prepared;  // what was done for it; empty: nothing
};

// The start of a scene. Where time begins before 0, the conventional stepper as it is by default takes it to 0:
// whatever steps the scene from there on starts from the same bits. Nothing of that is recorded. Absent: stopped.
// Throws Error where a step is rejected.
std::optional<Start> prepare(const Setup&, const std::function<bool()>& stop = {}, Progress* progress = nullptr,
                             const StopFlag& interrupt = {});

}  // namespace selvedge
