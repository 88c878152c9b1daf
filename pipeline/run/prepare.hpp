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

// The start of a scene. If its time begins before 0, the default conventional stepper takes it to time 0, so that all
// steppers start from the same bits; nothing of that is recorded. Absent: stopped. Throws Error if a step is rejected.
std::optional<Start> prepare(const Setup&, const std::function<bool()>& stop = {}, Progress* progress = nullptr,
                             const StopFlag& interrupt = {});

}  // namespace selvedge
