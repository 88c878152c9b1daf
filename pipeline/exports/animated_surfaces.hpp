#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/hdf5/trajectory.hpp"

namespace selvedge {

// A cloth or an obstacle as other programs' files hold it.
struct AnimatedSurface {
  std::string name;
  Triangles triangles;
  int vertex_count = 0;
  bool cloth = true, moving = true;          // what never moves has the positions of frame 0
  Eigen::Vector3d colour = {0.7, 0.7, 0.7};  // linear, 0 to 1
  std::string file = {};                     // with which the names of its own files begin
  Look look = {};                            // of the file that it came from, whose vertices these are; may be empty
  Triangles cut = {};                        // with a look: the triangles, as indices of its corners
};

// A run as formats for other programs write it: frame i is at time i / fps.
struct AnimatedSurfaces {
  double fps = 30;
  int frame_count = 0;  // one at least
  std::vector<AnimatedSurface> surfaces;
  std::function<std::vector<PointsF>(int frame)> frame;  // the positions of every surface [m]
};

// Throws Error, naming surface, frame and vertex, where a position is not finite: `format` has no way to say so.
void check_finite(const AnimatedSurface&, const PointsF& x, int frame, const std::string& format);

}  // namespace selvedge
