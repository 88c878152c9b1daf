#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/hdf5/trajectory.hpp"

namespace selvedge {

// Positions of a surface over frames in few bytes: whole steps of one grid, each predicted from the frames before and
// from the vertex before it. Differences from the prediction are Rice codes (R. F. Rice, JPL 79-22, 1979). data.js
// reads them.
//
// A frame has, for x, y and z in turn: a bit for the prediction in time (0: as in the frame before, 1: on the line
// through the two frames before), a bit for whether differences are relative to that of the vertex before, five
// bits for the code's parameter k, then a code a vertex. Bits are read from the highest of a byte on.
struct PackedPositions {
  double step = 0;  // of the grid [m]
  std::string bytes;
  int frames = 0;
  std::vector<std::vector<int>> absent;  // by frame: vertices that are not finite, or 2^30 steps and more away

  std::vector<std::int64_t> last, before_last;  // steps in the two frames before, 3 a vertex
  unsigned open_bits = 0;                       // of the last byte, those that are not yet in `bytes`
  int open_count = 0;
};

// A step of at most 0.1 mm [m]. A box round these positions whose longest side is below 3.3 m has a 32,768th of that,
// but no less than 0.1 um, with which a surface may move 100 m, and no less than floats are rounded by where it is.
double grid_step(const PointsF&);

// Adds a frame; all frames have as many vertices. The code is whole at any time once `closed` was called on a copy.
void append(PackedPositions&, const PointsF&);
std::string closed(const PackedPositions&);

}  // namespace selvedge
