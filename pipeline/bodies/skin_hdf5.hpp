#pragma once

#include "pipeline/bodies/body.hpp"
#include "pipeline/hdf5/hdf5_fields.hpp"

namespace selvedge::h5 {

// Reads and writes the fields that bodies and garments share: rest, triangles, weights, shape_directions,
// pose_directions.
SkinnedSurface read_skin(const Fields&, Eigen::Index joints);
void write_skin(const File&, const SkinnedSurface&);

}  // namespace selvedge::h5
