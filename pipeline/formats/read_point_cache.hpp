#pragma once

#include <filesystem>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Positions of one mesh in every frame, without its faces, in the file's unit and axes.
struct PointCache {
  double fps = 0;              // 0: the file does not say
  std::vector<Points> frames;  // one at least, n x 3 each
};

// By extension: .pc2 (point cache 2, floats), .pc16 (the same with half floats, as CLOTH3D stores garments: Bertiche et
// al. 2020), .mdd (with times, which must be evenly spaced). Throws Error with file, and frame and vertex where one is
// not finite: for another head than the format's, and a size that does not fit the head.
PointCache read_point_cache(const std::filesystem::path&);

}  // namespace selvedge
