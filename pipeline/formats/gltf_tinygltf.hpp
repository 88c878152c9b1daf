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

// A place in the tree of a glTF file: what its transform is without animation.
struct GltfNode {
  std::string name;  // node7 where the file has none
  int parent = -1;   // before its children; -1: none
  Vec3 translation = Vec3::Zero(), scale = Vec3::Ones();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

enum class GltfPath { translation, rotation, scale };
enum class GltfInterpolation { step, linear, cubic };

// How one part of a node's transform goes with time.
struct GltfTrack {
  int node = 0;
  GltfPath path = GltfPath::translation;
  GltfInterpolation interpolation = GltfInterpolation::linear;
  Eigen::VectorXd times;  // ascending, one at least [s]
  Eigen::MatrixXd
      values;  // a row a time, x y z or a quaternion x y z w; cubic: three rows a time, tangent, value, tangent
};

struct GltfAnimation {
  std::string name;  // animation0 where the file has none
  std::vector<GltfTrack> tracks;
};

// What a glTF file has of one skin and the meshes that it deforms.
struct GltfScene {
  std::vector<GltfNode> nodes;                           // parents first
  std::vector<int> joints;                               // of the skin: nodes
  std::vector<Eigen::Matrix4d> inverse_bind;             // of each joint: from the mesh's space to the joint's
  Mesh mesh;                                             // what the skin deforms, as stored; groups: the meshes
  Eigen::SparseMatrix<double, Eigen::RowMajor> weights;  // vertices x joints, rows sum to 1
  std::vector<GltfAnimation> animations;
};

// Reads a rigged mesh, glTF 2.0 (.glb, or .gltf with what it names beside it). Vertices that differ only in texture or
// normal are joined, so that what was closed is closed. Of other files only buffers are opened, and only below the
// file's own folder; images never. Throws Error, naming the file and the part
// of it: no skin or several that are used, no triangles, compressed or sparse data, numbers that lie outside of their
// buffers or are not finite, weights that are all zero; a choice of meshes that it has not, or that leaves none.
GltfScene read_gltf(const std::filesystem::path&, const NameChoice& = {});

}  // namespace selvedge
