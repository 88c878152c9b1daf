#pragma once

#include <filesystem>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

// A garment in our HDF5 format, docs/garments.md. Reading gives exactly what was written. Writes to a file beside it
// and renames that. Both throw Error.
void write_garment(const std::filesystem::path&, const Garment&);
Garment read_garment(const std::filesystem::path&);

}  // namespace selvedge
