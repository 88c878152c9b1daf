#pragma once

#include <functional>

namespace selvedge {

// Whether to end the work at hand. Asked again and again while it goes on: it must be cheap, and once true stay true.
// Empty: never.
using StopFlag = std::function<bool()>;

inline bool stopped(const StopFlag& stop) { return stop && stop(); }

}  // namespace selvedge
