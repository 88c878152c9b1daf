#pragma once

#include <filesystem>

#include "pipeline/bodies/body.hpp"
#include "pipeline/config/name_choice.hpp"

namespace selvedge {

// A body of a mesh (OBJ, PLY) and a file (YAML) that says where its joints are; weights as `bone_weights` makes them.
// The joints of the right side may be left out: they are those of the left, mirrored at the plane through the pelvis
// across x. A leaf's bone, hand, foot or head, goes on half as far as it is from its parent. The zero pose and the
// origin are the mesh's. No shapes, no pose directions. `metres`: of one unit of the mesh; joints are in metres or have
// their units. Throws Error with file and line: as the readers do, for a joint outside the body where it is closed, and
// for one that nothing bends at.
BodyModel read_jointed(const std::filesystem::path& mesh, const std::filesystem::path& joints, double metres,
                       const NameChoice& = {});

}  // namespace selvedge
