#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "learned/network/weights.hpp"
#include "pipeline/weights/torch_archive.hpp"

namespace selvedge {

// A published checkpoint as a network of ours, and where it is from.
struct ImportedWeights {
  Architecture architecture;
  NetworkWeights weights;
  FeatureSums<float> sums;         // that the statistics among the weights were made of
  std::string file;                // its name, without the folder
  std::uint64_t bytes = 0;         // its size
  std::vector<std::string> parts;  // keys at its top: training_module, config, ..
  long long numbers = 0;           // in the tensors that were read, statistics included
};

// Reads a checkpoint of HOOD (hood_final or postcvpr, hood_cvpr, fine15, fine48) or of ContourCraft, of any width. The
// names of its tensors say which it is. Every name and every shape must be as published (docs/weights.md), and a
// missing, extra or misshapen tensor throws Error that names it. Statistics become mean and deviation in the authors'
// float32 order (parity README, 9). The optimiser's state is not read. Safety: pickle.hpp, stored_archive.hpp.
ImportedWeights read_published_weights(const std::filesystem::path&);

// Where imported weights are from, name and value, as a weight file keeps it.
std::vector<std::pair<std::string, std::string>> origin_of(const ImportedWeights&);

}  // namespace selvedge
