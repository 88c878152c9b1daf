#pragma once

#include "pipeline/config/config.hpp"
#include "pipeline/shapes/motion.hpp"

namespace selvedge {

// Reads a `motion` section; absent: at rest. `x`: the moving points; the middle of their box is the default centre.
Motion read_motion(const Config& section, const Points& x);

Interpolation read_interpolation(const Config&);

// Throws Error unless the items' `time` ascends.
void check_ascending_times(const Config& keyframes);

// Applies the keys scale, rotate and translate of a cloth or obstacle.
Points placed(const Config& section, const Points& x);

// Length of a file's unit [m]: a `unit` value.
double read_unit(const Config&);

}  // namespace selvedge
