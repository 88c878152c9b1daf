#pragma once

#include <vector>

#include "collision/geometry/surface.hpp"

namespace selvedge {

// Which triangles of a surface to turn round so that neighbours run along their common edge in opposite directions.
struct TurnedAlike {
  std::vector<signed char> turn;  // of each triangle, +1 or -1; the first of each part stays
  std::vector<int> part;          // of each triangle: its part, which edges connect
  std::vector<char> orientable;   // of each part: such turns exist, and no edge has three triangles
  int parts() const { return static_cast<int>(orientable.size()); }
};

TurnedAlike turned_alike(const Surface&);

}  // namespace selvedge
