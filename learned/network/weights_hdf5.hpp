#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "learned/network/weights.hpp"

namespace selvedge {

// All that a weight file holds. `version` is that of the program that wrote it.
struct WeightFile {
  Architecture architecture;
  NetworkWeights weights;
  std::string training;                                     // options of the training, as text; empty where unknown
  std::vector<std::pair<std::string, std::string>> origin;  // provenance: name and value
  std::string version;
  std::string trained_on = {};  // who and what was trained on, as JSON; empty where unknown
};

// A weight file is an HDF5 file: texts `format`, `version`, `architecture` (architecture_text.hpp) and `training`,
// where it is known a text `trained_on`, lists of texts `origin_names` and `origin_values`, and below `weights` one
// dataset of 32-bit or 16-bit floats an array
// (`weight_arrays`). Its user block of 512 bytes begins with a line that names the form and a checksum of all bytes
// behind it.
//
// How trained numbers are stored. `half` is IEEE's binary16: half the size, each number changed by 5e-4 of itself at
// most. Those below 6.1e-5 become zero. Statistics are stored as 32-bit floats in both.
enum class WeightStorage { single, half };

// Written beside and renamed: another process sees the old file or the new one. Throws Error for what cannot be
// written, for weights that are not of the architecture's shapes, and for weights that are too large for `half`.
void write_weight_file(const std::filesystem::path&, const WeightFile&, WeightStorage = WeightStorage::single);

// Throws one Error, with file and field, for whatever is no whole weight file. The checksum is looked at before HDF5
// reads a byte, so that damage never reaches it. Against files that are wrong on purpose: ranks, extents and kinds are
// compared with what the architecture asks for before anything is read, the architecture's size with the file's before
// anything is allocated, and datasets that lie elsewhere (links, external storage) or are compressed are refused.
// Nothing in the file is executed.
WeightFile read_weight_file(const std::filesystem::path&);

// Writes the checksum into the user block. Only for files that another program has changed on purpose.
void seal_weight_file(const std::filesystem::path&);

}  // namespace selvedge
