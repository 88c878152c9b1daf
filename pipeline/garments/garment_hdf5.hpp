#pragma once

#include <filesystem>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

// A garment in our HDF5 form, docs/garments.md. Both throw Error; what is written is read back to the bit. Written
// beside and renamed.
void write_garment(const std::filesystem::path&, const Garment&);
Garment read_garment(const std::filesystem::path&);

}  // namespace selvedge
