#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "learned/network/weights.hpp"

namespace selvedge {

// The content of a weight file. `version` is that of the program that wrote it.
struct WeightFile {
  Architecture architecture;
  NetworkWeights weights;
  std::string training;                                     // options of the training as text; empty: unknown
  std::vector<std::pair<std::string, std::string>> origin;  // provenance: name and value
  std::string version;
  std::string trained_on = {};  // people and garments of the training as JSON; empty: unknown
};

// A weight file is an HDF5 file with texts `format`, `version`, `architecture` (architecture_text.hpp), `training` and,
// where known, `trained_on`, lists of texts `origin_names` and `origin_values`, and below `weights` one dataset of
// 32-bit or 16-bit floats per array (`weight_arrays`). Its user block of 512 bytes begins with a line that names the
// form and a checksum of all bytes after it (weight_seal.hpp). `half` stores trained numbers as IEEE's binary16,
// of half the size. It changes each number by at most 5e-4 of itself, and those below 6.1e-5 become zero. Statistics
// stay 32-bit floats.
enum class WeightStorage { single, half };

// Writes a new file and renames it, so that another process sees the old file or the new one. Throws Error where it
// cannot write, for weights in other shapes than the architecture's, and for weights too large for `half`.
void write_weight_file(const std::filesystem::path&, const WeightFile&, WeightStorage = WeightStorage::single);

// Throws one Error, with file and field, for anything but a whole weight file. The checksum is tested before HDF5 reads
// a byte, so that damage never reaches it. Malicious files are refused too: ranks, extents and kinds must fit the
// architecture before anything is read, and its size the file's before memory is allocated. Linked, external and
// compressed datasets are refused. Nothing in the file is executed.
WeightFile read_weight_file(const std::filesystem::path&);

}  // namespace selvedge
