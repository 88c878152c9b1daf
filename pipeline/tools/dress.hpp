#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/garments/garment.hpp"
#include "pipeline/garments/mesh_frame.hpp"

namespace selvedge {

struct DressRequest {
  std::filesystem::path mesh;          // mesh of the garment on the body (OBJ, PLY)
  std::filesystem::path out;           // garment file (HDF5)
  std::optional<std::string> unit;     // unit of the mesh; absent: guessed from the body
  std::optional<Up> up;                // axis of the mesh that points up; absent: guessed from the body
  std::string body = "mannequin";      // or a file, as `model` of a scene
  std::vector<double> shape;           // shape of the body under the mesh
  std::optional<std::string> pose;     // a clip, as `clip` of a scene; absent: the zero pose
  double time = 0;                     // time in the clip [s]
  std::vector<std::string> rotations;  // JOINT=x,y,z: axis times angle [rad], which replaces the pose's
  std::string fit = "loose";           // loose or tight
  std::vector<std::string> pins;  // groups that stay with the body, or none; empty: waists of garments that would fall
  bool weld = false;              // joins pieces where their borders meet (mesh_weld.hpp)
  std::optional<double> weld_within{};  // distance for that [m]; absent: weld_distance
};

struct DressReport {
  Garment garment;
  MeshFrame frame;           // unit and axis in which the mesh was taken
  std::string frame_reason;  // why, where they were guessed; empty: both were given
  int welded = 0;            // vertices that were joined to others
  int weldable = 0;          // vertices that welding would join; 0 where it was asked for
  int components = 0;
  std::vector<std::string> pinned;  // names of groups
  double reposed = 0;               // largest distance between the mesh and the garment in the same pose [m]
  double least_distance = 0, mean_distance = 0;  // from vertices to the body's surface [m]
  bool on_body = true;                           // result of worn_part.hpp
  int inside_vertices = 0;                       // vertices inside a closed body
  int self_pairs = 0, body_pairs = 0;            // intersecting triangles, with itself and with the body
  std::vector<std::string> warnings;
};

// Makes a garment from a mesh on a body and writes it: weights and directions come from the body's surface there,
// groups from the mesh and its boundaries, and pins. Throws Error for files that cannot be read or written, and where
// unit or axis are absent and several would put the mesh on the body about equally well.
DressReport dress(const DressRequest&);

// Whether the garment is on the body, without intersecting pairs and without vertices inside the body.
bool is_clean(const DressReport&);

std::string dress_json(const DressReport&);
std::string dress_text(const DressReport&);

}  // namespace selvedge
