#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/motions/clip.hpp"

// Motions in the Biovision hierarchy format.
namespace selvedge {

enum class BvhChannel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

struct BvhJoint {
  std::string name;
  int parent = -1;
  Vec3 offset = Vec3::Zero();  // from the parent, in the file's unit
  std::vector<BvhChannel> channels;
  int first_channel = 0;  // column of the motion
};

// The content of a file, with its own names, unit and axes.
struct BvhFile {
  std::string file;
  std::vector<BvhJoint> joints;  // parents first; end sites are left out
  double fps = 0;
  Eigen::MatrixXd motion;  // frames x channels, rotations in degrees
};

// Reads any order of channels, none to six per joint. Throws Error with file and line.
BvhFile read_bvh(const std::filesystem::path&);
BvhFile parse_bvh(std::string_view text, const std::string& name);

// Rotation of each joint in the file's axes and position of each in its unit. frame -1: the zero pose of the file.
// Joints from the root to `pelvis` (-1: the root alone) move by their position channels, other bones keep their length.
// The channels of a joint below the root count from its parent if they begin near its offset, else from the offset.
struct BvhPose {
  std::vector<Mat3> rotations;
  Points positions;
};
BvhPose bvh_pose(const BvhFile&, int frame, int pelvis = -1);

struct BvhOptions {
  std::map<std::string, std::string> joints;  // joints of the file by SMPL's names; others are matched by common names
  double scale = 0;                           // metres per unit; 0: so that the legs are as long as the body's
  int rest_frame = -1;  // in which it stands upright; -1: the zero pose of the file, or frame 0 if that is not upright
  std::optional<double> floor;  // y of the soles in the body's zero pose, as in make_clip
};

// Index of the file's joint for each of SMPL's 24, -1 for none: by the options, else by the naming of the rig that fits
// best (CMU, Mixamo, LAFAN, MakeHuman, Biped, Blender, Rigify, Poser, Daz, SMPL, Unreal, Unity, VRM, Reallusion, Xsens,
// MotionBuilder, Motive, Kinect, Bandai Namco), ignoring a common prefix of all names. Throws Error for an unknown name
// in the options, and if hips, knees, ankles, shoulders or elbows are missing.
std::vector<int> matched_joints(const BvhFile&, const std::map<std::string, std::string>& joints);

// The motion for a body with these 24 joints in its zero pose. The rest poses of file and body differ, so that
// rotations cannot be copied. Both are taken as standing upright. The body's upper arms, forearms, thighs and shins are
// first turned, by the least rotation, to the directions of the file's at rest. Then each joint turns the body's bone
// as it turns the file's from rest. Trunk, head, collars and feet count as equal at rest, except for the heading. The
// axis along which the file's figure stands becomes Y; its heading stays. Only the translation of the hips and of what
// they hang on is used: it is scaled, starts above the origin, and the lowest foot of the clip touches the ground.
// Throws Error if the rest pose does not stand upright.
Clip retargeted(const BvhFile&, const Points& joints, const BvhOptions&);

}  // namespace selvedge
