#pragma once

#include <filesystem>
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

// Where a draped start is kept while it is made, so that one that was stopped or killed can go on.
struct KeptDraping {
  std::filesystem::path folder;  // of the run; results of an earlier run there are removed
  bool goes_on = false;          // begin with the state that the folder has
  double seconds = 30;  // between two times of keeping it; it is kept at the start and where it is stopped, too
};
std::filesystem::path draping_file(const std::filesystem::path& folder);

// The start of a scene. If its time begins before 0, the default conventional stepper takes it to time 0, so that all
// steppers start from the same bits; nothing of that is recorded. Absent: stopped. Throws Error if a step is rejected,
// and as read_draping does.
std::optional<Start> prepare(const Setup&, const std::function<bool()>& stop = {}, Progress* progress = nullptr,
                             const StopFlag& interrupt = {}, const std::optional<KeptDraping>& kept = {});

}  // namespace selvedge
