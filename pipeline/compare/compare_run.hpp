#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/compare/compare_parts.hpp"

namespace selvedge {

struct TimedRunOptions {
  bool measured = true;   // false: times and counts alone
  int judged_frames = 4;  // RunMeasures
  RowLimits limits{};
  std::filesystem::path trajectory{};  // where the run is kept; empty: nowhere
};

// One run of the scene with the time of each frame, and with what is measured between them. It ends
// early where it exceeds a limit, and says so. Absent: stopped.
std::optional<CompareRun> timed_run(const Setup&, const TimedRunOptions&, const Stop&);

// Whether every frame of a kept run is a network's own: nothing gated, responded to, pushed or made by somebody else
// after the start. Says what is not so; empty: it is.
std::string trouble_of_bare_run(const std::filesystem::path& trajectory);

}  // namespace selvedge
