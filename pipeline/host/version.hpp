#pragma once

namespace selvedge {

const char* program_version();

}  // namespace selvedge
