#pragma once

#include <memory>
#include <optional>
#include <string>

#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/hdf5/trajectory_hdf5.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// An interrupted run: the state from which to continue, and the frames up to it.
struct ResumedRun {
  State state;
  RunInputs inputs;
  std::unique_ptr<TrajectoryReader> frames;  // 0 to state.frame
};

// Reads checkpoint.h5 and run.h5 of the folder. Before use, all of it is compared with the scene, and both files with
// each other. Throws Error with file, field, its value and the scene's: for nothing to resume, another configuration,
// an input file that has changed, arrays of other types, shapes or lengths, and frames of another run.
ResumedRun read_resumed(const std::filesystem::path& folder, const Setup&, const StepperTraits&, const RunInputs&);

// The state of a draped start that was stopped or killed, from the file in which `prepare` keeps it. Throws Error, as
// read_resumed does, for a file of another scene, and for a moment that is not before time 0.
State read_draping(const std::filesystem::path& file, const Setup&, const RunInputs&);

// A run that ended by itself, as its summary.json says.
struct EndedRun {
  std::string summary = {};  // that file
  std::string text = {};     // for people
  bool clean = false;
};

// The run in the folder if it has ended by itself; absent: there is none, or it was stopped. Throws Error, as
// read_resumed does, where it was made under another configuration or of other inputs.
std::optional<EndedRun> read_ended(const std::filesystem::path& folder, const RunInputs& inputs);

// Throws Error, naming the checkpoint's field and the input, if the files with which a run began are not those that are
// read now. `reader`: what reads them, such as "the scene".
void check_input_files(const std::filesystem::path& checkpoint, const std::vector<InputFile>& before,
                       const std::vector<InputFile>& now, const std::string& reader);

// The frame with that number, which must be the last one. Throws Error if it has positions that are not finite.
Frame resumed_frame(const ResumedRun&, int index, const std::filesystem::path& folder);

}  // namespace selvedge
