#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/bodies/body.hpp"
#include "pipeline/formats/gltf_tinygltf.hpp"
#include "pipeline/motions/clip.hpp"

// Rigged bodies of glTF files, and their animations.
namespace selvedge {

// A body from a file, and the data that its animations need.
struct GltfRig {
  std::string file;
  GltfScene scene;
  BodyModel body;
  std::vector<int> joints;                               // for each joint of the body its index in the skin
  Eigen::Matrix4d placed = Eigen::Matrix4d::Identity();  // from the mesh's space to the zero pose
};

// The body in the pose in which its skin was bound, with the size and orientation of the file's own nodes: metres, Y
// up, as in glTF. Joints above the first one that branches or has weights are left out. The others get SMPL's names if
// the naming of the rig is known (matched_joints of clip_bvh.hpp). No shapes, no pose directions. The regressor gives
// each joint its place. Throws Error as read_gltf does, and for a skin with uneven scale or several roots.
GltfRig read_gltf_rig(const std::filesystem::path&, const NameChoice& = {});

// One of the file's animations as rotations of the body's joints from its zero pose; `name` empty: the first. With the
// body's skinning the surface moves as the file says. Time 0 is the file's. Throws Error, naming joint and time, if a
// joint is scaled or moves relative to its parent by over a centimetre (bones must keep their lengths), and for a name
// that the file lacks.
Clip read_gltf_clip(const GltfRig&, const std::string& name, double fps);

// Poses per second such that every key of an animation is at a pose: 60 or the next larger number. Warns if there is
// none up to 240, and if the animation begins later than at time 0.
double gltf_rate(const GltfRig&, const std::string& name, std::vector<std::string>& warnings);

}  // namespace selvedge
