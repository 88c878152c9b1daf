#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "pipeline/motions/clip.hpp"

// Clips are rotations from SMPL's zero pose, the T-pose: arms out, palms down, legs straight. Bodies are often modelled
// in another pose, with lowered arms.
namespace selvedge {

// Positions of SMPL's joints in a body, 24 x 3; missing hands are at the wrists. Throws Error if another joint is
// missing. joints: positions of the body's joints, one row each.
Points smpl_joints(const BodyModel&, const Points& joints);

// World rotations of SMPL's 24 joints that let limbs point in wanted directions. Trunk, head and feet turn by `trunk`.
// Thighs, shins, upper arms, forearms and hands turn, from bone to bone down the limb, by the least further rotation to
// wanted(joint, child). If that is zero, or the bone has no length, a bone follows the one above it. A least rotation
// does not twist the skin along the bone. joints: 24 x 3.
std::vector<Mat3> turned_limbs(const Points& joints, const Mat3& trunk,
                               const std::function<Vec3(int joint, int child)>& wanted);

// The pose in which a body stands as the mannequin does in its zero pose. Nothing if it does so already: its upper arms
// and forearms are within 20 degrees of the mannequin's, as SMPL's are. joints: positions in the body's zero pose, one
// row each; joints that SMPL does not have follow their parents. Throws Error as smpl_joints does.
std::optional<BodyPose> t_pose(const BodyModel&, const Points& joints);

// The largest angle of upper arms and forearms from the mannequin's in its zero pose [rad]. joints: 24 x 3.
double arms_off_t_pose(const Points& joints);

// Converts a clip of rotations from the T-pose to rotations of the body's own joints from its own zero pose. Since
// skinning is linear, the surface moves as if it had been modelled in its T-pose.
Clip from_own_zero_pose(const Clip&, const BodyModel&, const Points& joints, const BodyPose& t_pose);

}  // namespace selvedge
