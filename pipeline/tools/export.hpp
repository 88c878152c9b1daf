#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace selvedge {

struct ExportRequest {
  std::filesystem::path trajectory;
  // obj, ply: a mesh a frame; pc2, mdd: a point cache and the mesh of frame 0; glb, usda: one animated file; xdmf: a
  // sidecar of the trajectory
  std::string format = "obj";
  std::filesystem::path out;                          // folder
  bool obstacles = false;                             // also the obstacles, each under its own name
  std::function<void(int done, int all)> progress{};  // of frames read, over all passes; may be empty
};

// Returns the files written, in order. Throws Error for an unknown format, a run without a frame, and what the format
// cannot hold.
std::vector<std::filesystem::path> export_trajectory(const ExportRequest&);

}  // namespace selvedge
