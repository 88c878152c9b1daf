#pragma once

#include "pipeline/cells/cell_list.hpp"

namespace selvedge {

// The cells of a file: a comparison, a stability suite, a data set of drapes, or a work file, which names its kind
// under `cells`. They are told apart by their keys (docs/cells.md). Throws Error with file, line and key.
CellList read_cells(const std::filesystem::path& file);

}  // namespace selvedge
