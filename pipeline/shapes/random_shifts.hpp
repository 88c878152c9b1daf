#pragma once

#include <cstdint>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Rows of three numbers in [-1, 1), the same on every machine.
Points random_shifts(Eigen::Index rows, std::uint64_t seed);

}  // namespace selvedge
