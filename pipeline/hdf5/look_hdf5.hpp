#pragma once

#include <string>

#include "pipeline/formats/look.hpp"
#include "pipeline/hdf5/hdf5_handles.hpp"

namespace selvedge::h5 {

// A look as a group of a file; docs/files.md lists its fields. What the look lacks is not written.
void write_look(const File&, const std::string& group, const Look&);

// Reads that group; an empty look where there is none. `vertices`: of the surface. Throws Error for sizes and indices
// that do not fit.
Look read_look(const File&, const std::string& group, Eigen::Index vertices);

}  // namespace selvedge::h5
