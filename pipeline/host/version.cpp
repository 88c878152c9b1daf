#include "pipeline/host/version.hpp"

namespace selvedge {

const char* program_version() { return SELVEDGE_VERSION; }

}  // namespace selvedge
