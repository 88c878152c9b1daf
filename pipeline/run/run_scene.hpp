#pragma once

#include <filesystem>
#include <functional>

#include "pipeline/run/prepare.hpp"
#include "pipeline/run/progress.hpp"
#include "pipeline/run/summary.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

struct RunRequest {
  std::filesystem::path out;       // folder, made if it does not exist
  bool locked = false;             // the caller has locked the folder (folder_lock.hpp); false: run_scene does it
  double checkpoint_seconds = 30;  // between checkpoints
  Progress* progress = nullptr;
  std::function<bool()> stop;  // asked after every frame; true ends the run cleanly
  StopFlag interrupt;          // asked within steps: true ends the run at its last whole frame (before one: Stopped)
  std::function<void(const FrameEvent&)> observe;  // called for every frame, outside the measured time
};

// Simulates a scene from its start into a folder: run.h5 (trajectory), run.xdmf, summary.json, config.yaml (whose
// `folder` is the scene's), and checkpoint.h5 from the first frame until the run has finished. A rejected step is
// recorded as a frame with the last accepted positions and ends the run. Throws Error if files cannot be written, or
// another process is running into the folder.
RunSummary run_scene(const Setup&, const Start&, Stepper&, const RunRequest&);

// Continues from the checkpoint of an interrupted run in the folder. Throws the same, and what read_resumed does.
RunSummary resume_scene(const Setup&, Stepper&, const RunRequest&);

}  // namespace selvedge
