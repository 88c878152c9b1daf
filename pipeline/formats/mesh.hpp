#pragma once

#include <string>
#include <utility>
#include <vector>

#include "collision/geometry/points.hpp"

namespace selvedge {

// A triangle mesh as a file has it.
struct Mesh {
  Points x;
  Triangles triangles;  // polygons fanned from their first corner; degenerate and duplicate triangles removed, counted
                        // in warnings
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv;  // texture vertices (OBJ vt), may be empty
  Triangles uv_triangles;                                        // corner -> row of uv; empty where a face has none
  std::vector<std::pair<std::string, std::vector<int>>> groups;  // OBJ g / o: name and its vertices
  std::vector<std::string> warnings;
};

}  // namespace selvedge
