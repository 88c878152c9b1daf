#pragma once

#include <filesystem>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// Positions of one mesh in every frame, without its faces, in the file's unit and axes.
struct PointCache {
  double fps = 0;              // 0: the file does not say
  std::vector<double> at;      // time of each sample, ascending [frames of 1 / fps]
  std::vector<Points> frames;  // the samples: at least one, n x 3 each
};

// Reads by extension: .pc2 (point cache 2, floats, with the first sample's frame and the number of frames per sample),
// .pc16 (the same with half floats, as CLOTH3D stores garments: Bertiche et al. 2020), .mdd (with times [s]; if these
// are uneven, fps is 1). Throws Error with the file for a wrong header, times that do not ascend, and a size that does
// not match the header, and with frame and vertex for a position that is not finite.
PointCache read_point_cache(const std::filesystem::path&);

}  // namespace selvedge
