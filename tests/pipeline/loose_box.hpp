#pragma once

#include <string>

#include <fmt/format.h>

#include "collision/geometry/points.hpp"

namespace selvedge::fake {

// A box of four-sided faces that share no vertex in the file; `gap` is how far its lid is off [m].
inline std::string loose_box(double gap) {
  std::string vertices, faces;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, 1}) {
      for (const auto& [u, v] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = side ? u : v;
        p[(axis + 2) % 3] = side ? v : u;
        p *= 0.1;
        if (axis == 1 && side) p.y() += gap;
        vertices += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
      }
      faces += fmt::format("f {} {} {} {}\n", count + 1, count + 2, count + 3, count + 4);
      count += 4;
    }
  return vertices + faces;
}

}  // namespace selvedge::fake
