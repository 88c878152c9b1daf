#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pipeline/formats/trajectory.hpp"

// Readers of exported files, written from the formats' texts without any code of the writers.
namespace selvedge::read_animated {

struct Surface {
  Triangles triangles;
  std::vector<double> times;  // [s]
  std::vector<PointsF> x;     // at each time
};

// Point caches, without triangles.
Surface pc2(const std::filesystem::path&);
Surface mdd(const std::filesystem::path&);
// Surfaces by the name of node or prim. A surface at rest has one time.
std::map<std::string, Surface> glb(const std::filesystem::path&);
std::map<std::string, Surface> usda(const std::filesystem::path&);

}  // namespace selvedge::read_animated
