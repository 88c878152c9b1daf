#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// A file from which a scene was read: its name as in error messages, and a hash of its bytes.
struct InputFile {
  std::string name;
  std::uint64_t hash = 0;
};

// All inputs of a run. A resumed run must have the same.
struct RunInputs {
  std::string config;
  std::vector<InputFile> files;
  std::uint64_t scene = 0;  // hash of the scene that files and code made
};

struct Checkpoint {
  State state;
  RunInputs inputs;
  bool knows_files = true;  // false: written by an earlier version, which stored the configuration alone
};

// Writes the state in full precision, so that a resumed run continues with the same bits. Writes to a file beside it
// and renames that. Throws Error if it cannot be written.
void write_checkpoint(const std::filesystem::path&, const State&, const RunInputs&);

// Throws Error, with file and field, if there is no checkpoint or it is damaged: arrays whose types, shapes or lengths
// do not match, numbers that are not finite or out of range for any scene, and a frame before `first_frame`, which is
// below 0 for draped starts.
Checkpoint read_checkpoint(const std::filesystem::path&, int first_frame = 0);

// Throws Error, with the field, its value and that of the scene, unless the state has as many vertices, obstacles and
// triangles as the scene.
void check_fits(const std::filesystem::path&, const State&, const Scene&);

}  // namespace selvedge
