#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "physics/scene/scene.hpp"
#include "physics/scene/stepper.hpp"

namespace selvedge {

// A file that a scene was read from, by the name that its error messages have, and a hash of its bytes.
struct InputFile {
  std::string name;
  std::uint64_t hash = 0;
};

// All that makes a run: one that is resumed must have the same.
struct RunInputs {
  std::string config;
  std::vector<InputFile> files;
  std::uint64_t scene = 0;  // hash of what files and code have made
};

struct Checkpoint {
  State state;
  RunInputs inputs;
  bool knows_files = true;  // false: an earlier version of this program wrote it, which noted the configuration alone
};

// The state in full precision, so that a resumed run goes on with the same bits. Written beside and renamed.
void write_checkpoint(const std::filesystem::path&, const State&, const RunInputs&);

// Throws Error, with file and field, when there is none, and when it is damaged: arrays of other types, shapes or
// lengths than the rest of it, numbers that are not finite or beyond what any scene has.
Checkpoint read_checkpoint(const std::filesystem::path&);

// Throws Error, with the field, what is there and what the scene has, unless the state has as many
// vertices, obstacles and triangles as the scene.
void check_fits(const std::filesystem::path&, const State&, const Scene&);

}  // namespace selvedge
