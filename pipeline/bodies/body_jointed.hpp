#pragma once

#include <filesystem>

#include "pipeline/bodies/body.hpp"
#include "pipeline/config/name_choice.hpp"

namespace selvedge {

// Reads a body from a mesh (OBJ, PLY) and a file (YAML) with the places of its joints; weights are those of
// `bone_weights`. Joints of the right side may be left out: then the left ones are mirrored at the plane x = const
// through the pelvis. The bone of a leaf (hand, foot or head) continues half as far as the leaf is from its parent.
// Zero pose and origin are the mesh's. No shapes, no pose directions. `metres`: length of one unit of the mesh; joints
// are in metres or have their units. Throws Error with file and line: as the readers do, for a joint outside a closed
// body, and for a joint at which nothing bends.
BodyModel read_jointed(const std::filesystem::path& mesh, const std::filesystem::path& joints, double metres,
                       const NameChoice& = {});

}  // namespace selvedge
