#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"

namespace selvedge {

struct DressRequest {
  std::filesystem::path mesh;          // of the garment, where the body wears it (OBJ, PLY)
  std::filesystem::path out;           // its HDF5 form
  std::string unit = "m";              // of the mesh
  std::string body = "mannequin";      // or a file, as a scene's `model`
  std::vector<double> shape;           // of the body that wears the mesh
  std::optional<std::string> pose;     // a clip, as a scene's `clip`; absent: the zero pose
  double time = 0;                     // of the clip [s]
  std::vector<std::string> rotations;  // JOINT=x,y,z: axis times angle [rad], in place of the pose's
  std::string fit = "loose";           // or tight
  std::vector<std::string> pins;       // groups that stay with the body, or none; empty: waists of what would fall
};

struct DressReport {
  Garment garment;
  int components = 0;
  std::vector<std::string> pinned;  // groups
  double reposed = 0;               // largest distance of the garment, put into the pose again, from the mesh [m]
  double least_distance = 0, mean_distance = 0;  // from vertices to the body's surface [m]
  bool on_body = true;                           // as worn_part.hpp has it
  int inside_vertices = 0;                       // in a closed body
  int self_pairs = 0, body_pairs = 0;            // intersecting triangles, with itself and with the body
  std::vector<std::string> warnings;
};

// Makes a garment of a mesh that a body wears: weights and directions from the surface of the body as it is there,
// groups of the mesh and of its boundaries, pins; and writes it. Throws Error for what cannot be read or written.
DressReport dress(const DressRequest&);

// On the body, without pairs, and nothing inside the body.
bool is_clean(const DressReport&);

std::string dress_json(const DressReport&);
std::string dress_text(const DressReport&);

}  // namespace selvedge
