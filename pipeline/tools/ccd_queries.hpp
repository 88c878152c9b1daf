#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "collision/exact/moving_polygon.hpp"
#include "collision/geometry/points.hpp"

namespace selvedge {

// A continuous detection whose answer is known: do the primitives touch while their nodes move straight?
struct CcdQuery {
  PairKind kind = PairKind::vertex_face;
  std::array<Vec3, 4> x0, x1;
  bool contact = false;
  int line = 0;  // of its first row
};

// The format of the Sample-Queries for continuous collision detection: eight rows a query, the nodes at the start and
// then at the end, each `x_num,x_den,y_num,y_den,z_num,z_den,truth`: whole numbers, and 0 or 1, the same in all eight.
// The folder that the file is in, or one farther up, is named edge-edge or vertex-face.
// Coordinates must be doubles exactly: the answer for others could be a different one, so they are errors, as are rows
// of another form. Errors name file, line and cure.
std::vector<CcdQuery> read_ccd_queries(const std::filesystem::path&);

}  // namespace selvedge
