#pragma once

#include <filesystem>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Positions of one mesh in every frame, without its faces, in the file's unit and axes.
struct PointCache {
  double fps = 0;              // 0: the file does not say
  std::vector<double> at;      // when each sample is, ascending [frames of 1 / fps]
  std::vector<Points> frames;  // the samples: one at least, n x 3 each
};

// By extension: .pc2 (point cache 2, floats, with the first sample's frame and the frames a sample), .pc16 (the same
// with half floats, as CLOTH3D stores garments: Bertiche et al. 2020), .mdd (with times [s]; where they are uneven, fps
// is 1). Throws Error with file, and frame and vertex where one is not finite: for another head than the format's,
// times that do not ascend, and a size that does not fit the head.
PointCache read_point_cache(const std::filesystem::path&);

}  // namespace selvedge
