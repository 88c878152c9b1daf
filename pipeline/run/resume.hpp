#pragma once

#include <memory>

#include "pipeline/formats/checkpoint.hpp"
#include "pipeline/formats/trajectory_hdf5.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// An interrupted run: the state to go on from, and the frames up to it.
struct ResumedRun {
  State state;
  RunInputs inputs;
  std::unique_ptr<TrajectoryReader> frames;  // 0 to state.frame
};

// Reads checkpoint.h5 and run.h5 of the folder. Before anything of them is used, all of it is compared with the scene,
// and the two with each other. Throws Error with file and field, what is there and what the scene has: there is nothing
// to resume, another configuration, a file that has changed since, arrays of other types, shapes or lengths, frames of
// another run.
ResumedRun read_resumed(const std::filesystem::path& folder, const Setup&, const StepperTraits&, const RunInputs&);

// Throws Error, naming the checkpoint's field and the input, where the files that a run began with are not those that
// `reader` reads now: "the scene".
void check_input_files(const std::filesystem::path& checkpoint, const std::vector<InputFile>& before,
                       const std::vector<InputFile>& now, const std::string& reader);

// The frame of that number, which no other must follow. Throws Error where it holds positions that are not finite.
Frame resumed_frame(const ResumedRun&, int index, const std::filesystem::path& folder);

}  // namespace selvedge
