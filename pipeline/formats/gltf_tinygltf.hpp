#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include "pipeline/config/name_choice.hpp"
#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// A node in the tree of a glTF file, with its transform without animation.
struct GltfNode {
  std::string name;  // node7 where the file has none
  int parent = -1;   // before its children; -1: none
  Vec3 translation = Vec3::Zero(), scale = Vec3::Ones();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

enum class GltfPath { translation, rotation, scale };
enum class GltfInterpolation { step, linear, cubic };

// One part of a node's transform over time.
struct GltfTrack {
  int node = 0;
  GltfPath path = GltfPath::translation;
  GltfInterpolation interpolation = GltfInterpolation::linear;
  Eigen::VectorXd times;  // ascending, at least one [s]
  Eigen::MatrixXd
      values;  // one row per time, x y z or a quaternion x y z w; cubic: three rows, tangent, value, tangent
};

struct GltfAnimation {
  std::string name;  // animation0 where the file has none
  std::vector<GltfTrack> tracks;
  bool morphs = false;  // it moves morph targets too, which no track has
};

// The skins of a glTF file and the meshes that they deform.
struct GltfScene {
  std::vector<GltfNode> nodes;                           // parents first
  std::vector<int> joints;                               // of the skins: nodes
  std::vector<Eigen::Matrix4d> inverse_bind;             // of each joint: from the mesh's space to the joint's
  Mesh mesh;                                             // the deformed surface, as stored; its groups are the meshes
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;  // vertices x joints, rows sum to 1
  std::vector<GltfAnimation> animations;
};

// Reads a rigged mesh, glTF 2.0 (.glb, or .gltf with the files that it names beside it). Vertices that differ only in
// texture or normal are joined, so that closed surfaces stay closed. Morph targets count with the weights that the file
// gives them. Meshes may have skins of their own that bind the same joints alike. Of other files only buffers are
// opened, only below the file's own folder, and never images. Throws Error, naming the file and the part of it, for no
// skin that is used, skins that bind a joint differently, no triangles, compressed data, numbers outside of their
// buffers or not finite, weights that are all zero, and a choice of meshes that the file lacks or that leaves none.
GltfScene read_gltf(const std::filesystem::path&, const NameChoice& = {});

}  // namespace selvedge
