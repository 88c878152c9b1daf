#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "learned/network/weights.hpp"
#include "pipeline/weights/torch_archive.hpp"

namespace selvedge {

// A published checkpoint as a network of ours, with its origin.
struct ImportedWeights {
  Architecture architecture;
  NetworkWeights weights;
  FeatureSums<float> sums;         // sums from which the statistics were made
  std::string file;                // name without the folder
  std::uint64_t bytes = 0;         // size of the file
  std::vector<std::string> parts;  // keys at its top: training_module, config, ..
  long long numbers = 0;           // count of numbers read, statistics included
};

// Reads a checkpoint of HOOD (hood_final or postcvpr, hood_cvpr, fine15, fine48) or of ContourCraft, of any width. The
// names of its tensors tell which one it is. Every name and every shape must be as published (docs/weights.md). Throws
// Error that names a tensor which is missing, extra or misshapen. Statistics become mean and deviation in the authors'
// float32 order (parity README, 9). The optimiser's state is not read. Safety: pickle.hpp, torch_archive.hpp.
ImportedWeights read_published_weights(const std::filesystem::path&);

// The origin of imported weights as names and values, for the weight file.
std::vector<std::pair<std::string, std::string>> origin_of(const ImportedWeights&);

}  // namespace selvedge
