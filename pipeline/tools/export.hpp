#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace selvedge {

struct ExportRequest {
  std::filesystem::path trajectory;
  std::string format = "obj";  // obj, ply: a mesh a frame; pc2: one point cache and the mesh of frame 0; xdmf
  std::filesystem::path out;   // folder
  bool obstacles = false;      // also the obstacles, each under its own name
};

// Returns the files written, in order. Throws Error for an unknown format.
std::vector<std::filesystem::path> export_trajectory(const ExportRequest&);

}  // namespace selvedge
