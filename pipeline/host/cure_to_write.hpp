#pragma once

#include <string>

namespace selvedge {

// What helps where a write has failed for this reason, as the system words it ("No space left on device").
std::string cure_to_write(const std::string& reason);

}  // namespace selvedge
