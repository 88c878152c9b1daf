#pragma once

#include "pipeline/formats/checkpoint.hpp"
#include "pipeline/scene/setup.hpp"

namespace selvedge {

// What a run of the scene is made of: its configuration, a hash of each file that a value of it names (meshes, clips,
// bodies, garments, caches, sequences, weights; of a .gltf file also those that it names), and a hash of what files and
// code have made of them. Asks for the drive at time 0.
RunInputs run_inputs(const Setup&);

// The files that texts name, seen from the folder, each once with a hash of its bytes; of a .gltf file also those that
// it names. Texts that name no file are left out.
std::vector<InputFile> hashed_files(const std::vector<std::string>& texts, const std::filesystem::path& folder);

}  // namespace selvedge
