#pragma once

#include <filesystem>

#include "pipeline/bodies/body.hpp"
#include "pipeline/config/name_choice.hpp"

namespace selvedge {

// A body of MakeHuman's default rig: a mesh (OBJ, PLY), a skeleton (.mhskel) and weights (.mhw), by SMPL's 24 joints.
// Each bone goes to the joint of itself or of the next bone above it that has one; what a vertex has of all bones of a
// joint is added up, and its sum scaled to 1. Joints are where the bones' reference vertices say. Many of these are of
// helpers, so the mesh is best the whole base mesh, of which the group `body` becomes the body; of a mesh without them
// a joint is the mean of its vertices, weighted by the product of what they have of the joint and of its parent.
// Vertices that no face of the body uses are left out, the others stay in their order. The zero pose and the origin are
// the mesh's. No shapes, no pose directions. `metres`: of one unit of the mesh. Throws Error with the file and what is
// wrong: as read_rig_bones and read_rig_weights, for a missing bone, a vertex without weights, a mesh in which the
// vertices are not in the order of the weights, and a joint outside the vertices that move with it.
BodyModel read_makehuman(const std::filesystem::path& mesh, const std::filesystem::path& skeleton,
                         const std::filesystem::path& weights, double metres, const NameChoice& = {});

}  // namespace selvedge
