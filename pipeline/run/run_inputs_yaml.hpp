#pragma once

#include <cstdint>

#include "pipeline/formats/checkpoint.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// The inputs of a run: its configuration, a hash of each file that one of its values names (meshes, clips, bodies,
// garments, caches, sequences, weights; for a .gltf file also those that it names), and a hash of the scene that files
// and code made. Calls for the drive at time 0.
RunInputs run_inputs(const Setup&);

// One hash of all of them.
std::uint64_t hash_of_inputs(const RunInputs&);

// The files that texts name, relative to the folder, each once with a hash of its bytes; for a .gltf file also those
// that it names. Texts that name no file are left out.
std::vector<InputFile> hashed_files(const std::vector<std::string>& texts, const std::filesystem::path& folder);

}  // namespace selvedge
