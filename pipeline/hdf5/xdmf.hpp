#pragma once

#include <filesystem>
#include <string>

#include "pipeline/hdf5/trajectory_hdf5.hpp"

namespace selvedge {

// XDMF text that lets ParaView play a trajectory: a temporal collection over the file `h5_name`, which must be in the
// same folder.
std::string xdmf_text(const TrajectoryInfo&, const std::vector<double>& times, const std::string& h5_name);

// Writes it beside the trajectory, with the ending .xdmf.
std::filesystem::path write_xdmf(const std::filesystem::path& trajectory);

}  // namespace selvedge
