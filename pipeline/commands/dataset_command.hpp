#pragma once

#include "pipeline/drapes/make_drapes.hpp"

namespace selvedge {

// The command `selvedge dataset`; see commands.hpp for what it returns.
int dataset_command(const DatasetRequest&, bool json);

}  // namespace selvedge
