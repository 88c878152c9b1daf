#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/config/name_choice.hpp"
#include "pipeline/formats/mesh_io.hpp"

namespace selvedge {

// The body in a mesh: rows of the mesh, and its triangles by rows of the body.
struct BodyPart {
  std::vector<int> vertices, row_of;  // row_of: -1 for what is not of the body
  Triangles triangles;
};

// Without a choice the group `body` of a mesh, or all of it where there is no such group; else the triangles of the
// groups that are chosen. Vertices that no triangle of these uses are left out, the others stay in their order. Throws
// Error, naming `file`, if it has no triangles or not the groups.
BodyPart body_part(const Mesh&, const std::filesystem::path& file, const NameChoice& = {});

// A body of that part with the file's name, its groups as meshes and SMPL's joints and tree, no shapes and no pose
// directions; its weights and its regressor are still to come.
BodyModel body_without_rig(const Mesh&, const BodyPart&, const std::filesystem::path& file);

}  // namespace selvedge
