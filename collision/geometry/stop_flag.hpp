#pragma once

#include <functional>

namespace selvedge {

// Whether to end the work at hand. Called often during the work: it must be cheap, and stay true once it is true.
// Empty: never.
using StopFlag = std::function<bool()>;

inline bool stopped(const StopFlag& stop) { return stop && stop(); }

}  // namespace selvedge
