#pragma once

#include <filesystem>

#include "pipeline/drapes/drape_set.hpp"

namespace selvedge {

// Paths in our HDF5 form (docs/repulsion.md): shape, style, rotations (drape by drape, one row per joint), positions,
// and counts of dropped drapes. A new file is written and renamed. Both throw Error.
void write_drape_path(const std::filesystem::path&, const DrapePath&);
DrapePath read_drape_path(const std::filesystem::path&, int joints, int vertices);

// The drapes of a folder that make_dataset filled.
struct DrapeSet {
  DrapeWorld world;
  std::vector<DrapePath> training, test;
};
std::filesystem::path drape_path_file(const std::filesystem::path& folder, int number);
DrapeSet read_drape_set(const std::filesystem::path& folder);

}  // namespace selvedge
