#pragma once

#include <filesystem>

#include "pipeline/bodies/body.hpp"

namespace selvedge {

// Any rigged body in our HDF5 form, docs/bodies.md. Both throw Error; what is written is read back to the bit. Written
// beside and renamed.
void write_body(const std::filesystem::path&, const BodyModel&);
BodyModel read_body(const std::filesystem::path&);

}  // namespace selvedge
