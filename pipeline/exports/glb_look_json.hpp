#pragma once

#include "pipeline/exports/export_materials.hpp"
#include "pipeline/exports/moved_normals.hpp"
#include "pipeline/host/json_text.hpp"

namespace selvedge {

// The vertices of a glTF mesh, which have one texture coordinate and one normal each: those of the surface in their
// order, and behind them those again that texture coordinates or normals part.
struct SplitVertices {
  std::vector<int> own;         // of each: the surface's vertex; empty: the surface has no look, and nothing is parted
  std::vector<int> uv, normal;  // of each: row of the look's uv, normal slot; -1: none
  NormalSlots slots;
};

// Parts the vertices of each surface with a look. The surfaces and positions of the run become those of the parted
// vertices; it must not outlive `run`.
AnimatedSurfaces split_vertices(const AnimatedSurfaces& run, std::vector<SplitVertices>&);

// A row a parted vertex: the texture coordinates as glTF has them, from the top left, and the normals at positions x
// of the parted vertices.
Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor> gltf_uv(const Look&, const SplitVertices&);
PointsF gltf_normals(const Look&, const SplitVertices&, const PointsF& x);

// Triangles that become a primitive: those of one part and one material.
struct GltfPrimitive {
  int part = -1, material = -1;  // of the look; -1: none
  std::vector<int> triangles;
};
std::vector<GltfPrimitive> primitives_of(const AnimatedSurface&);

// The materials, images and textures of a file, by the tables' names; to them surfaces add what they have by default.
void put_materials(const ExportMaterials&, Json& materials, Json& all);

// What a primitive says of its part, in `extras`; empty where it has no names.
Json part_extras(const Look&, int part);

}  // namespace selvedge
