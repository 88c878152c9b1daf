#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "collision/geometry/points.hpp"
#include "pipeline/formats/look.hpp"

namespace selvedge {

// Parts of a mesh: names, and the vertices of each, ascending.
using NamedVertices = std::vector<std::pair<std::string, std::vector<int>>>;

// The vertices of the part of that name, which is added where there is none.
inline std::vector<int>& group_named(NamedVertices& parts, const std::string& name) {
  const auto known = std::ranges::find(parts, name, &NamedVertices::value_type::first);
  return known != parts.end() ? known->second : parts.emplace_back(name, std::vector<int>()).second;
}

// A triangle mesh as a file has it.
struct Mesh {
  Points x;
  Triangles triangles;  // of the polygons (polygon.hpp); degenerate and duplicate ones removed, counted in warnings
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> uv;  // texture vertices (OBJ vt), may be empty
  Triangles uv_triangles;                                        // corner -> row of uv, -1 for none; empty: no uv
  NamedVertices groups;                                          // OBJ g / o, meshes of glTF
  std::vector<int> corners, corner_begin;  // vertices of the polygons as read, and where each begins; empty: not read
  std::vector<int> welded;  // of each vertex as read: its number after coincident ones were joined; empty: not joined
  Look look;                // what the file says beyond that
  std::vector<std::pair<std::filesystem::path, std::string>>
      material_files;  // OBJ mtllib: the mesh's folder, its words
  std::vector<std::string> warnings;
};

}  // namespace selvedge
