#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/config/name_choice.hpp"
#include "pipeline/formats/mesh.hpp"

namespace selvedge {

// The body in a mesh: rows of the mesh, and its triangles by rows of the body.
struct BodyPart {
  std::vector<int> vertices, row_of;  // row_of: of each row of the mesh, -1 if it is not in the body
  Triangles triangles;
};

// The triangles of the chosen groups; without a choice those of the group `body`, or all if there is no such group.
// Vertices without such triangles are left out; the others keep their order. Throws Error, naming `file`, if a group
// does not exist or there are no triangles.
BodyPart body_part(const Mesh&, const std::filesystem::path& file, const NameChoice& = {});

// A body of that part with the file's name, its groups as meshes, and SMPL's joints and tree. It has no shapes and no
// pose directions; callers must set weights and regressor.
BodyModel body_without_rig(const Mesh&, const BodyPart&, const std::filesystem::path& file);

}  // namespace selvedge
