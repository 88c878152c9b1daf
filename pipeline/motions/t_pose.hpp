#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "pipeline/motions/clip.hpp"

// Clips turn joints from SMPL's zero pose, the T-pose: arms out, palms down, legs straight. Bodies are often modelled
// in another pose, with their arms lowered.
namespace selvedge {

// SMPL's joints among those of a body, 24 x 3; hands that it lacks are where its wrists are. Throws Error if another
// one is missing. joints: of the body, one row each.
Points smpl_joints(const BodyModel&, const Points& joints);

// How SMPL's 24 joints turn in the world so that limbs point elsewhere: trunk, head and feet as `trunk` says; thighs,
// shins, upper arms, forearms and hands by the least further rotation, from bone to bone down the limb, that takes them
// along wanted(joint, child). Where that is zero, or the bone has no length, a bone follows the one above it. A least
// rotation does not twist the skin along the bone. joints: 24 x 3.
std::vector<Mat3> turned_limbs(const Points& joints, const Mat3& trunk,
                               const std::function<Vec3(int joint, int child)>& wanted);

// The pose in which a body stands as the mannequin does in its zero pose; nothing if it does so already: its upper arms
// and forearms lie within 20 degrees of the mannequin's, as those of SMPL. joints: of the body in its zero pose, one
// row each; those that SMPL does not know go with their parents. Throws Error as smpl_joints does.
std::optional<BodyPose> t_pose(const BodyModel&, const Points& joints);

// The largest angle between upper arms and forearms and the mannequin's in its zero pose [rad]. joints: 24 x 3.
double arms_off_t_pose(const Points& joints);

// A clip of rotations from the T-pose as one of rotations from the body's own zero pose, by the body's own joints. As
// the surface is blended linearly, it moves as if its T-pose were the one it was modelled in.
Clip from_own_zero_pose(const Clip&, const BodyModel&, const Points& joints, const BodyPose& t_pose);

}  // namespace selvedge
