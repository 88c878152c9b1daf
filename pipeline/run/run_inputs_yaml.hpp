#pragma once

#include <cstdint>

#include "pipeline/hdf5/checkpoint.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The inputs of a run: its configuration, a hash of each file that one of its values names (meshes, clips, bodies,
// garments, caches, sequences, weights; for a .gltf file also those that it names), and a hash of the scene that files
// and code made. Calls for the drive at time 0.
RunInputs run_inputs(const Setup&);

// The files among them, and the folder that their names are relative to.
std::vector<InputFile> input_files(const Setup&);
std::filesystem::path input_folder(const Setup&);

// One hash of all of them.
std::uint64_t hash_of_inputs(const RunInputs&);

// A hash of the configuration and of the bytes of the files that it names, the same wherever these files lie. Code's
// part of a scene is not in it: for results that are kept with a hash of the program.
std::uint64_t hash_anywhere(const Setup&);

// The files that texts name, relative to the folder, each once with a hash of its bytes; for a .gltf file also those
// that it names. Texts that name no file are left out.
std::vector<InputFile> hashed_files(const std::vector<std::string>& texts, const std::filesystem::path& folder);

}  // namespace selvedge
