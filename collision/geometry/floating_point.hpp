#pragma once

namespace selvedge {

// Exact signs and continuous detection rely on rounding to nearest and on gradual underflow. Libraries built with
// -ffast-math, or that are fast with tiny numbers on purpose, switch flush-to-zero and denormals-are-zero on, for a
// thread and all that it starts later. This makes arithmetic standard again on the calling thread and on every thread
// of the team that a parallel region started from it gets; until somebody changes it. A few microseconds: call it where
// a step or an audit begins, and again after foreign code has run in between.
void restore_standard_arithmetic();

}  // namespace selvedge
