#include "tests/program.hpp"

namespace selvedge {

const char* tested_program() { return SELVEDGE_PROGRAM; }

}  // namespace selvedge
