#pragma once

#include "collision/geometry/surface.hpp"

namespace selvedge {

// A body whose vertices move straight from x0 to x1.
struct MovingBody {
  const Surface* surface = nullptr;
  const Points *x0 = nullptr, *x1 = nullptr;
};

}  // namespace selvedge
