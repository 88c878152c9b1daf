#pragma once

namespace selvedge {

// Exact signs and continuous detection rely on rounding to nearest and on gradual underflow. Libraries built with
// -ffast-math, and some others, switch flush-to-zero and denormals-are-zero on, for a thread and all threads that it
// starts later. This makes arithmetic standard again on the calling thread and on the OpenMP threads that its parallel
// regions use, until other code changes it. It takes a few microseconds: call it where a step or an audit begins, and
// again after foreign code has run in between.
void restore_standard_arithmetic();

}  // namespace selvedge
