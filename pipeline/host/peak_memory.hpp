#pragma once

#include <cstdint>

namespace selvedge {

// Largest resident memory of this process since the last reset [bytes]; 0 where the system does not tell.
std::int64_t peak_memory();

// Starts the count anew where the system allows it (Linux).
void reset_peak_memory();

}  // namespace selvedge
