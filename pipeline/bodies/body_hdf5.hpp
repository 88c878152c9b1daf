#pragma once

#include <filesystem>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Any rigged body in our HDF5 format, docs/bodies.md. Reading gives exactly what was written. Writes to a file beside
// it and renames that. Both throw Error.
void write_body(const std::filesystem::path&, const BodyModel&);
BodyModel read_body(const std::filesystem::path&);

}  // namespace selvedge
