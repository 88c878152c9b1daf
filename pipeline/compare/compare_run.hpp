#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/compare/compare_parts.hpp"
#include "pipeline/run/prepare.hpp"

namespace selvedge {

struct TimedRunOptions {
  bool measured = true;   // false: times and counts alone
  int judged_frames = 4;  // RunMeasures
  RowLimits limits{};
  std::filesystem::path trajectory{};  // where the run is kept; empty: nowhere
};

// Runs the scene from its start, times each frame, and measures between the frames. The run ends early if it exceeds a
// limit, and says so. Absent if it was stopped.
std::optional<CompareRun> timed_run(const Setup&, const Start&, const TimedRunOptions&, const Stop&);

// Checks that a network alone made every frame of a kept run after the start: none was gated, responded to or made by
// another stepper, and none was pushed out of a body but the first, where a network that settles does so itself (HOOD).
// Returns the reason if it is not so, else an empty text.
std::string trouble_of_bare_run(const std::filesystem::path& trajectory);

}  // namespace selvedge
