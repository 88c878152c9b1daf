#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/bodies/up_axis.hpp"
#include "pipeline/config/name_choice.hpp"
#include "pipeline/shapes/own_crossings.hpp"

namespace selvedge {

struct BodyRequest {
  std::filesystem::path file;  // SMPL family (.npz), glTF with a skin (.glb, .gltf), or a mesh with the files below
  std::filesystem::path skeleton, weights;  // MakeHuman's .mhskel and .mhw
  std::string unit = "m";                   // unit of the mesh
  std::filesystem::path out;                // our HDF5 form (.h5)
  std::filesystem::path joints{};           // positions of the joints (.yaml), in place of skeleton and weights
  NameChoice meshes{};                      // meshes of glTF or groups of the mesh that become the body
  Up up = Up::y;                            // axis of the mesh, and of the positions of its joints, that points up
};

struct BodyReport {
  std::filesystem::path out;
  int vertices = 0, triangles = 0, joints = 0, shapes = 0;
  bool closed = false;
  double height = 0;                    // height in the zero pose [m]
  double arms_off = 0;                  // largest angle of upper arms and forearms to SMPL's zero pose [rad]
  bool t_pose = false;                  // near enough to SMPL's zero pose that clips turn from it
  std::string lacks;                    // a missing joint of SMPL, so that only its own animations move it; empty: none
  std::vector<std::string> animations;  // names of a glTF file's animations
  std::vector<std::string> meshes;      // names of the meshes in the body, if its file has names
  OwnCrossings crossings;               // in the zero pose
  std::vector<std::string> warnings;
};

// Reads a body by its extension and writes it for scenes. Throws Error that names missing parts of the request, and as
// the readers do.
BodyReport convert_body(const BodyRequest&);

std::string body_json(const BodyReport&);
std::string body_text(const BodyReport&);

}  // namespace selvedge
