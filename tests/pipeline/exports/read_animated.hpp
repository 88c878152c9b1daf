#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/hdf5/trajectory.hpp"

// Readers of exported files, written from the formats' texts without any code of the writers.
namespace selvedge::read_animated {

// What files do not say is empty.
struct Surface {
  Triangles triangles;
  std::vector<double> times;     // [s]
  std::vector<PointsF> x;        // at each time
  std::vector<int> counts;       // of corners of each face, USD
  std::vector<int> corners;      // of all faces, USD
  Eigen::MatrixXd uv;            // from the lower left: of each vertex (glTF), of each corner (USD)
  std::vector<PointsF> normals;  // at each time, likewise
  std::map<std::string, std::vector<int>> materials;  // by name, the faces (USD) or triangles (glTF) that have it
  std::map<std::string, std::vector<int>> parts;      // by name of the groups
};

// Point caches, without triangles.
Surface pc2(const std::filesystem::path&);
Surface mdd(const std::filesystem::path&);
// Surfaces by the name of node or prim. A surface at rest has one time.
std::map<std::string, Surface> glb(const std::filesystem::path&);
std::map<std::string, Surface> usda(const std::filesystem::path&);

}  // namespace selvedge::read_animated
