#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/tools/garment_errors.hpp"

namespace selvedge {

// Pushes a garment mesh out of a body by one of the compared methods, and measures it before and after.
struct PushRequest {
  std::filesystem::path file;                  // garment (OBJ, PLY) [m]
  std::filesystem::path body;                  // mesh
  std::optional<std::filesystem::path> truth;  // mesh of the same faces
  std::optional<std::filesystem::path> out;    // pushed garment (OBJ, PLY)
  std::string method = "layer";                // layer, smooth (as DRAPE) or none
  std::string shape = "union";                 // treatment of a body that intersects itself: union or raw
  double alpha = 1;                            // scale of the layer
  double margin = 0;                           // [m]
  int recheck = 3, edge_pass = 0;
};

struct PushReport {
  GarmentErrors before, after;
  int vertices = 0, triangles = 0, body_triangles = 0;
  bool body_closed = true, body_crosses_itself = false;
  int pushed = 0, deep = 0, torn = 0, projected = 0;                 // repulsive_layer.hpp
  int edges = 0, faces = 0;                                          // edge_pass.hpp
  double seconds_distance = 0, seconds_push = 0, seconds_edges = 0;  // the first one is for one query of all vertices
  std::vector<std::string> warnings;
};

// Throws Error for files that cannot be read, for other words than those above, and for a truth with other faces.
PushReport push_mesh(const PushRequest&);
std::string push_text(const PushReport&);
std::string push_json(const PushReport&);

}  // namespace selvedge
