#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "collision/exact/moving_polygon.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// A query of continuous collision detection with a known answer: do the primitives touch during a straight motion?
struct CcdQuery {
  PairKind kind = PairKind::vertex_face;
  std::array<Vec3, 4> x0, x1;
  bool contact = false;
  int line = 0;  // line of its first row
};

// Reads the format of the Sample-Queries for continuous collision detection. A query has eight rows, the nodes at the
// start and then at the end, each `x_num,x_den,y_num,y_den,z_num,z_den,truth`. Truth is 0 or 1, the same in all eight;
// the rest are whole numbers. The file's folder, or one above it, is named edge-edge or vertex-face. Coordinates must
// be doubles exactly, because rounded ones could have another answer. Errors name file, line and cure.
std::vector<CcdQuery> read_ccd_queries(const std::filesystem::path&);

}  // namespace selvedge
