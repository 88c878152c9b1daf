#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/formats/gltf_tinygltf.hpp"
#include "pipeline/motions/clip.hpp"

// Rigged bodies of glTF files, and their animations.
namespace selvedge {

// A body as a file has it, and what its animations need.
struct GltfRig {
  std::string file;
  GltfScene scene;
  BodyModel body;
  std::vector<int> joints;                               // of the body's joints: which of the skin's
  Eigen::Matrix4d placed = Eigen::Matrix4d::Identity();  // from the mesh's space to the zero pose
};

// The body in the pose in which its skin was bound, as large and turned as the file's own nodes have it: metres, Y up,
// as glTF is. Joints without weights above the first that branches or has some are left out; the others have SMPL's
// names where the rig's are known (matched_joints of clip_bvh.hpp). No shapes, no pose directions. The regressor gives
// each joint its place. Throws Error as read_gltf does, and for a skin that is scaled unevenly or has several roots.
GltfRig read_gltf_rig(const std::filesystem::path&, const NameChoice& = {});

// One of the file's animations as rotations from the body's zero pose, by the body's joints; `name` empty: the first.
// Deformed by the body's skin the surface moves as the file says. Throws Error, naming joint and time, where a joint
// is scaled or moves against its parent by over a centimetre: bones keep their lengths; and for a name that the file
// has not. Its time 0 is the file's.
Clip read_gltf_clip(const GltfRig&, const std::string& name, double fps);

// Poses a second at which no key of an animation lies between two poses: 60 or the next number that is enough. Says
// where there is none up to 240, and where the animation begins later than at time 0.
double gltf_rate(const GltfRig&, const std::string& name, std::vector<std::string>& warnings);

}  // namespace selvedge
