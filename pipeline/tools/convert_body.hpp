#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/config/name_choice.hpp"
#include "pipeline/shapes/own_crossings.hpp"

namespace selvedge {

struct BodyRequest {
  std::filesystem::path file;               // SMPL family (.npz), glTF with a skin (.glb, .gltf), or a mesh with:
  std::filesystem::path skeleton, weights;  // MakeHuman's .mhskel and .mhw
  std::string unit = "m";                   // of the mesh
  std::filesystem::path out;                // our HDF5 form (.h5)
  std::filesystem::path joints{};           // or where its joints are (.yaml)
  NameChoice meshes{};                      // of glTF, or groups of the mesh: which become the body
};

struct BodyReport {
  std::filesystem::path out;
  int vertices = 0, triangles = 0, joints = 0, shapes = 0;
  bool closed = false;
  double height = 0;    // of the zero pose [m]
  double arms_off = 0;  // largest angle of upper arms and forearms to SMPL's zero pose [rad]
  bool t_pose = false;  // as near to it that clips turn from the zero pose
  std::string lacks;    // a joint of SMPL's that is not there, so that only its own animations move it; empty: none
  std::vector<std::string> animations;  // of a glTF file
  std::vector<std::string> meshes;      // that the body is made of, where its file names them
  OwnCrossings crossings;               // in the zero pose
  std::vector<std::string> warnings;
};

// Reads a body by its extension and writes it for scenes to use. Throws Error with what is missing in the request, and
// as the readers do.
BodyReport convert_body(const BodyRequest&);

std::string body_json(const BodyReport&);
std::string body_text(const BodyReport&);

}  // namespace selvedge
