#pragma once

#include <filesystem>

#include "pipeline/bodies/body.hpp"
#include "pipeline/config/name_choice.hpp"

namespace selvedge {

// Reads a body with MakeHuman's default rig: a mesh (OBJ, PLY), a skeleton (.mhskel) and weights (.mhw), reduced to
// SMPL's 24 joints. Each bone belongs to its own joint, or to that of the next bone above it that has one. A vertex'
// weights of all bones of a joint are summed, and all its weights scaled to sum 1. Joints are where the bones'
// reference vertices say. Many of these belong to helpers, so that the mesh should be the whole base mesh, of which the
// group `body` becomes the body. Without them a joint is the mean of its vertices, weighted by the product of their
// weights for the joint and its parent. Vertices that no face of the body uses are left out; the others keep their
// order. Zero pose and origin are the mesh's. No shapes, no pose directions. `metres`: length of one unit of the mesh.
// Throws Error with the file and the cause: as read_rig_bones and read_rig_weights do, for a missing bone, a vertex
// without weights, a mesh whose vertices are not in the order of the weights, and a joint outside the vertices that
// move with it.
BodyModel read_makehuman(const std::filesystem::path& mesh, const std::filesystem::path& skeleton,
                         const std::filesystem::path& weights, double metres, const NameChoice& = {});

}  // namespace selvedge
