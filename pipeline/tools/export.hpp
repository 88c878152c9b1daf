#pragma once

#include "pipeline/exports/export_formats.hpp"

namespace selvedge {

// Returns the written files in order. Throws Error for an unknown format, a run without a frame, and content that the
// format cannot hold; Stopped (stop_scope.hpp) between two frames, and then keeps no file that is not whole.
std::vector<std::filesystem::path> export_trajectory(const ExportRequest&);

// The names of the formats, each with a description in brackets.
std::string export_format_list();

}  // namespace selvedge
